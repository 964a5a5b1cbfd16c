#include "host/record/writer.hpp"

#include <malloc.h>
#include <signal.h>

#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

namespace voussoir::host {

void Writer::submit(std::function<void()> job) {
  wait();
  if (!thread_.joinable()) start();
  {
    const std::scoped_lock lock(guard_);
    job_ = std::move(job);
  }
  changed_.notify_all();
}

void Writer::wait() {
  std::unique_lock lock(guard_);
  changed_.wait(lock, [this] { return !job_; });
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

bool Writer::idle() const {
  const std::scoped_lock lock(guard_);
  return !job_;
}

/// The C library reserves 64 MB of addresses for the memory of a new thread. Where `ulimit -v` does not leave so much,
/// each piece of memory takes a page, until HDF5 finds none and ends the process; so this thread shares what others
/// have.
///
/// A thread inherits the signals that are blocked. Requests to stop are for the thread that computes, whose waiting
/// they may end, as it was when this thread did the writing.
void Writer::start() {
  mallopt(M_ARENA_MAX, 1);
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  std::string complaint;
  try {
    thread_ = std::jthread([this](const std::stop_token& stop) { work(stop); });
  } catch (const std::system_error& error) {
    complaint = error.code().message();
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  if (!complaint.empty()) throw std::runtime_error("the thread that writes results cannot be started: " + complaint);
}

void Writer::work(const std::stop_token& stop) {
  std::unique_lock lock(guard_);
  while (changed_.wait(lock, stop, [this] { return static_cast<bool>(job_); })) {
    lock.unlock();
    std::exception_ptr failure;
    try {
      job_();
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    job_ = nullptr;
    failure_ = failure;
    changed_.notify_all();
  }
}

}  // namespace voussoir::host
