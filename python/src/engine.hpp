#pragma once
/// The life of the engine in a Python process: one start, no use after fork(), an end before the interpreter's.

#include <functional>

namespace voussoir::python::engine {

/// Starts the engine, unless it runs already.
/// @param threads wanted number; 0: as the program chooses
/// @throws std::runtime_error where it runs with another number of threads, has ended, or was started before fork()
void start(int threads);

[[nodiscard]] bool started();  ///< false also where it was started before fork()
[[nodiscard]] int threads();   ///< of the engine that runs

/// Closes all batches, waits for calls of other threads and ends the engine. To be called once, with the interpreter
/// lock, when the interpreter ends; a child of fork() leaves everything as it is.
void finish();

/// True in a child of fork() whose parent had started the engine.
[[nodiscard]] bool forked();

/// A call that uses the engine, from the constructor to the destructor. Both need the interpreter lock.
class Call {
 public:
  /// @throws std::runtime_error where the engine does not run
  Call();
  ~Call();
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;
};

/// What is to be closed before the engine ends. The destructor takes it off the list.
class Closable {
 public:
  Closable();
  virtual ~Closable();
  Closable(const Closable&) = delete;
  Closable& operator=(const Closable&) = delete;
  /// Called without the interpreter lock.
  virtual void close() = 0;
};

/// Looks whether a signal such as Ctrl-C has arrived, or the interpreter ends. To be called without the interpreter
/// lock. @throws nanobind::python_error of the signal's handler; std::runtime_error at the end, and in a child whose
/// fork() a handler has called
void look_for_signals();

/// Runs `work`, which has no pauses, in a thread of its own, and looks for signals meanwhile. To be called without the
/// interpreter lock. @throws as `work` and look_for_signals
void run_stoppable(const std::function<void()>& work);

}  // namespace voussoir::python::engine
