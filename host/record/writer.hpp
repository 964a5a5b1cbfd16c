#pragma once
/// The thread that writes the files of a run, one job after another, while the run goes on.

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace voussoir::host {

/// At most one job is under way, so that a run is never more than one increment ahead of its files. The thread is
/// started by the first job; signals go to the other threads.
class Writer {
 public:
  Writer() = default;
  /// Waits for the job. A failure of it that nobody has met is dropped: to be told of it, call `wait` before.
  ~Writer() = default;
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// Waits as `wait` does, then begins the job on the thread.
  void submit(std::function<void()> job);
  /// Waits for the job to end. Throws what it has thrown, once.
  void wait();
  /// True where no job is under way; the last one may have failed.
  [[nodiscard]] bool idle() const;

 private:
  void start();
  void work(const std::stop_token& stop);

  mutable std::mutex guard_;  ///< of the members down to `failure_`
  std::condition_variable_any changed_;
  std::function<void()> job_;  ///< empty where none is under way
  std::exception_ptr failure_;
  std::jthread thread_;  ///< destroyed first, which ends the thread behind its job
};

}  // namespace voussoir::host
