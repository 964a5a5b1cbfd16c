#pragma once
/// The parts of an increment's work: how long each takes, and a listener that hears when one begins and ends, so that a
/// profiler can show the parts by their names. This library knows no profiler.

#include <chrono>

namespace voussoir::fem {

enum class Part {
  material,  ///< the answers of the batch, tangents included
  assembly,  ///< gradients, nodal forces and stiffness
  solution   ///< factorisations and solutions
};
[[nodiscard]] constexpr const char* to_string(Part part) {
  switch (part) {
    case Part::material:
      return "material";
    case Part::assembly:
      return "assembly";
    case Part::solution:
      return "solution";
  }
  return "unknown";
}

/// Wall time of each part.
struct PartTimes {
  double material = 0;  ///< of Part::material without the tangents [s]
  double tangents = 0;  ///< of the tangents, as the material reports it [s]
  double assembly = 0;  ///< [s]
  double solve = 0;     ///< of Part::solution [s]

  PartTimes& operator+=(const PartTimes& other) {
    material += other.material;
    tangents += other.tangents;
    assembly += other.assembly;
    solve += other.solve;
    return *this;
  }
  [[nodiscard]] double& of(Part part) {
    return part == Part::material ? material : part == Part::assembly ? assembly : solve;
  }
};

/// Either both functions are set or neither; parts begin and end in pairs on the thread that solves.
struct PartListener {
  void (*begin)(const char* name) = nullptr;
  void (*end)() = nullptr;
};
inline PartListener part_listener;  ///< one for the whole process; to be set while no part is running

/// Adds the time of its own life to a part, and tells the listener of it.
class PartTimer {
 public:
  PartTimer(PartTimes& times, Part part) : seconds_(times.of(part)), start_(Clock::now()) {
    if (part_listener.begin != nullptr) part_listener.begin(to_string(part));
  }
  ~PartTimer() {
    if (part_listener.end != nullptr) part_listener.end();
    seconds_ += std::chrono::duration<double>(Clock::now() - start_).count();
  }
  PartTimer(const PartTimer&) = delete;
  PartTimer& operator=(const PartTimer&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  double& seconds_;
  Clock::time_point start_;
};

}  // namespace voussoir::fem
