#include "host/library/c_calls.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <unordered_map>

#include "host/case/failure.hpp"

/// A handle outlives its RVEs, so that a late call with it is found and no address is used twice. It costs some dozens
/// of bytes for each set of RVEs that was ever made.
struct VoussoirRves {
  std::unique_ptr<voussoir::library::CRves> rves;
  const char* end = "";  ///< how the RVEs ended, as the rest of a sentence
};

namespace voussoir::library {

namespace {

/// The state of the interface in this process.
struct Process {
  std::mutex mutex;
  std::optional<Session> session;
  int asked = 0;              ///< number of threads that the start has asked for
  std::atomic<pid_t> pid{0};  ///< of the process that has started the threads; 0: none has
  std::unordered_map<const VoussoirRves*, std::unique_ptr<VoussoirRves>> handles;
};

/// It is never destroyed: the order in which a process destroys what is global is not ours, and RVEs must not outlive
/// Kokkos.
Process& process() {
  static Process* const the_process = new Process;
  return *the_process;
}

thread_local bool is_within_call = false;
/// An array, because a call may fail for want of memory, or after the thread's objects are destroyed. Longer sentences
/// are cut.
thread_local char sentence_of_error[4096] = "";

}  // namespace

const CRves* find_rves(const VoussoirRves* handle) {
  const auto found = process().handles.find(handle);
  return found == process().handles.end() ? nullptr : found->second->rves.get();
}

CRves& rves_of(const VoussoirRves* handle) {
  if (handle == nullptr) throw Misuse("the handle of the RVEs is NULL");
  const auto found = process().handles.find(handle);
  if (found == process().handles.end()) throw Misuse("the pointer is no handle of RVEs");
  if (!found->second->rves) throw Misuse(std::string("the RVEs of this handle ") + found->second->end);
  return *found->second->rves;
}

VoussoirRves* new_handle(std::unique_ptr<CRves> rves) {
  auto handle = std::make_unique<VoussoirRves>();
  handle->rves = std::move(rves);
  VoussoirRves* const address = handle.get();
  process().handles.emplace(address, std::move(handle));
  return address;
}

void free_rves(const VoussoirRves* handle) {
  static_cast<void>(rves_of(handle));
  VoussoirRves& ours = *process().handles.at(handle);
  ours.rves.reset();
  ours.end = "were freed by voussoir_destroy";
}

void start_threads(int threads) {
  if (threads < 0) throw Misuse("the number of threads is negative");
  Process& ours = process();
  if (ours.session) {
    const bool same = threads == 0 || threads == ours.asked || threads == ours.session->threads();
    if (!same) throw Misuse("runs with " + std::to_string(ours.session->threads()) + " threads already");
    return;
  }
  try {
    ours.session.emplace(threads);
  } catch (const std::logic_error& fault) {
    throw Misuse(fault.what());
  }
  ours.asked = threads;
  ours.pid = getpid();
}

void stop_threads() {
  Process& ours = process();
  for (auto& [address, handle] : ours.handles) {
    if (!handle->rves) continue;
    handle->rves.reset();
    handle->end = "were freed by voussoir_stop";
  }
  ours.session.reset();
}

int running_threads() { return process().session ? process().session->threads() : 0; }

void require_threads() {
  if (!process().session) throw Misuse("the threads do not run: call voussoir_start first");
}

Call::Call() {
  const pid_t starter = process().pid;
  // The lock may be held by a thread that a forked process does not have, and the threads of the engine are not there.
  if (starter != 0 && starter != getpid()) throw Misuse("this process was forked after voussoir_start");
  if (is_within_call) throw Misuse("the function was called within another call, by its note for example");
  process().mutex.lock();
  is_within_call = true;
}

Call::~Call() {
  is_within_call = false;
  process().mutex.unlock();
}

void remember(const std::string& sentence) noexcept {
  const std::size_t length = std::min(sentence.size(), sizeof sentence_of_error - 1);
  std::memcpy(sentence_of_error, sentence.data(), length);
  sentence_of_error[length] = '\0';
}

int remember(const char* function, const std::exception_ptr& exception) noexcept {
  try {
    std::rethrow_exception(exception);
  } catch (const Misuse& fault) {
    std::snprintf(sentence_of_error, sizeof sentence_of_error, "%s: %s", function, fault.what());
    return voussoir_misuse;
  } catch (...) {
  }
  try {
    const host::Failure failure = host::failure_of(exception);
    remember(failure.sentence);
    return host::exit_code(failure.outcome);
  } catch (...) {
    std::snprintf(sentence_of_error, sizeof sentence_of_error, "out of memory");
    return voussoir_machine_failure;
  }
}

const char* last_error() noexcept { return sentence_of_error; }

}  // namespace voussoir::library
