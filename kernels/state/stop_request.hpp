#pragma once
/// A request of another thread to end what this thread has called. The engine looks for it where it looks at stresses,
/// some hundred times a second, so that a person who waits for a packing can give up.

#include <atomic>
#include <exception>

namespace voussoir::kernels {

/// Thrown out of the call that was to end. What it was to compute is lost; committed states are as before.
class Stopped final : public std::exception {
 public:
  ~Stopped() override;  // defined once, so that all sets of lanes throw one and the same type
  [[nodiscard]] const char* what() const noexcept override { return "stopped on request"; }
};

/// From the constructor to the destructor, the calls of this thread end soon after `flag` has become true, by Stopped.
class Stoppable {
 public:
  explicit Stoppable(const std::atomic<bool>& flag);
  ~Stoppable();
  Stoppable(const Stoppable&) = delete;
  Stoppable& operator=(const Stoppable&) = delete;
};

/// The flag of the calling thread; null where nobody can stop it. A call hands it to its workers.
[[nodiscard]] const std::atomic<bool>* stop_flag();

/// @throws Stopped where the flag is true; null is never true
void end_where_stopped(const std::atomic<bool>* flag);

}  // namespace voussoir::kernels
