#include "python/src/engine.hpp"

#include <nanobind/nanobind.h>
#include <pthread.h>

#include <atomic>
#include <chrono>
#include <future>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>

#include "host/library/rves.hpp"
#include "kernels/state/stop_request.hpp"

namespace nb = nanobind;

namespace voussoir::python::engine {
namespace {

constexpr const char* after_fork =
    "voussoir was used in the parent process before fork(), and its threads are not in this one: start processes with "
    "the method \"spawn\" or \"forkserver\"";

std::mutex guard;                     ///< of the two below
library::Session* session = nullptr;  ///< left alone in a child of fork() and where the process ends without finish()
std::set<Closable*> closables;
std::atomic<bool> runs = false;
std::atomic<bool> is_child = false;  ///< of fork(), after the start
std::atomic<bool> ends = false;
std::atomic<int> calls = 0;

void start_locked(int wanted) {
  if (ends) throw std::runtime_error("the engine has ended in this process and cannot start again");
  if (!session) {
    session = new library::Session(wanted);
    runs = true;
    static const int told = pthread_atfork(nullptr, nullptr, [] { is_child = true; });
    static_cast<void>(told);
  } else if (wanted > 0 && wanted != session->threads()) {
    throw std::runtime_error("the engine runs with " + std::to_string(session->threads()) +
                             " threads and cannot change to " + std::to_string(wanted) +
                             ": call initialize() before anything else");
  }
}

}  // namespace

void start(int wanted) {
  if (is_child) throw std::runtime_error(after_fork);
  const nb::gil_scoped_release free;
  const std::lock_guard lock(guard);
  start_locked(wanted);
}

bool started() { return runs && !is_child; }

int threads() {
  const Call call;
  return session->threads();
}

bool forked() { return is_child; }

void finish() {
  if (is_child || !runs) return;
  ends = true;
  const nb::gil_scoped_release free;
  // A thread that is left when the interpreter ends must not come back into C++ code: it would be ended there.
  while (calls > 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  const std::lock_guard lock(guard);
  for (Closable* const open : closables) open->close();
  closables.clear();
  delete session;
  session = nullptr;
}

Call::Call() {
  if (is_child) throw std::runtime_error(after_fork);
  if (ends) throw std::runtime_error("the engine has ended, because the interpreter ends");
  if (!runs) throw std::runtime_error("the engine is not started: call initialize()");
  ++calls;
}

Call::~Call() { --calls; }

Closable::Closable() {
  const std::lock_guard lock(guard);
  closables.insert(this);
}

Closable::~Closable() {
  if (is_child) return;  // another thread may have had the guard at the time of fork()
  const std::lock_guard lock(guard);
  closables.erase(this);
}

void look_for_signals() {
  if (ends) throw std::runtime_error("the interpreter ends");
  const nb::gil_scoped_acquire lock;
  if (PyErr_CheckSignals() != 0) throw nb::python_error();
  if (is_child) throw std::runtime_error(after_fork);  // a handler has called fork()
}

void run_stoppable(const std::function<void()>& work) {
  constexpr auto nap = std::chrono::milliseconds(50);
  std::atomic<bool> stop = false;
  std::promise<void> done;
  std::future<void> end = done.get_future();
  std::thread thread([&] {
    const kernels::Stoppable stoppable(stop);
    try {
      work();
      done.set_value();
    } catch (...) {
      done.set_exception(std::current_exception());
    }
  });
  try {
    while (end.wait_for(nap) != std::future_status::ready) look_for_signals();
  } catch (...) {
    stop = true;
    if (is_child) {
      thread.detach();  // it is a thread of the parent
    } else {
      thread.join();
    }
    throw;
  }
  thread.join();
  end.get();
}

}  // namespace voussoir::python::engine
