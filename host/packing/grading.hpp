#pragma once
/// Grain sizes from a soil's grading curve.

#include <cstdint>
#include <random>
#include <vector>

#include "host/case/case.hpp"

namespace voussoir::host {

/// Random numbers, uniform in [0, 1). They are made from the bits of the standard library's engine, which are the same
/// in all implementations; the library's distributions are not.
class Uniform {
 public:
  explicit Uniform(std::int64_t seed) : engine_(static_cast<std::uint64_t>(seed)) {}
  double operator()() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }

 private:
  std::mt19937_64 engine_;
};

/// Radii [m] of `grains` discs, descending, from the soil's grading curve (linear in size between its points),
/// stratified: a small packing has the same grading as a large one.
[[nodiscard]] std::vector<double> sample_radii(const SoilCase& soil, int grains, std::int64_t seed);

}  // namespace voussoir::host
