#pragma once
/// Where the wall time of the increments goes.

#include <chrono>

namespace voussoir::fem {

struct PartTimes {
  double material = 0;  ///< the batch's answers, tangents included [s]
  double assembly = 0;  ///< gradients, nodal forces and stiffness [s]
  double solve = 0;     ///< factorisations and solutions [s]

  PartTimes& operator+=(const PartTimes& other) {
    material += other.material;
    assembly += other.assembly;
    solve += other.solve;
    return *this;
  }
};

/// Adds its own life to a part.
class PartTimer {
 public:
  explicit PartTimer(double& part) : part_(part), start_(Clock::now()) {}
  ~PartTimer() { part_ += std::chrono::duration<double>(Clock::now() - start_).count(); }
  PartTimer(const PartTimer&) = delete;
  PartTimer& operator=(const PartTimer&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  double& part_;
  Clock::time_point start_;
};

}  // namespace voussoir::fem
