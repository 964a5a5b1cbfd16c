#pragma once
/// What the benchmarks of the engine advance: RVEs of one packing, all sheared alike, that start from the same state
/// each time.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "host/packing/packings.hpp"
#include "kernels/advance_rves.hpp"
#include "kernels/isa/choose_lanes.hpp"

namespace voussoir::kernels {

inline constexpr double pressure = 1.0e5;    ///< [Pa]
inline constexpr double increment = 1.0e-3;  ///< shear strain eps_q of an evaluation [-]
inline constexpr int strain_steps = 400;

/// What is advanced again and again: never committed, so that every repetition does the same work.
struct Scene {
  RveBatch batch;
  std::vector<StrainRequest> requests;
  EngineSettings settings;
};

inline host::PackedRve packed(host::Case input) {
  input.packing.pressure = pressure;
  input.packing.folder = "out/benchmark";  // where tools/bench_peers looks for it
  const std::int64_t seed[] = {1};
  return host::obtain_packings(input.soil, input.packing, seed).front();
}

/// CPS_D: 700 grains.
inline const host::PackedRve& sand() {
  static const host::PackedRve rve = packed({});
  return rve;
}

inline std::size_t lanes_of(Precision precision) {
  return static_cast<std::size_t>(chosen_lanes().lanes->width(precision));
}

/// Pure shear of eps_q = `shear` whose major axis stands at `angle` to x, with `dilation` of every length.
inline Mat2 sheared(double angle, double shear, double dilation) {
  const double c = 0.5 * shear * std::cos(2.0 * angle), s = 0.5 * shear * std::sin(2.0 * angle);
  return identity2 + exp_minus_identity({dilation + c, s, s, dilation - c});
}

/// @param packings that share the RVEs; all are the same one, but the engine does not know this
inline Scene clones(const host::PackedRve& rve, std::size_t n, Precision precision, std::size_t packings = 1) {
  std::vector<int> of_rve(n);
  for (std::size_t k = 0; k < n; ++k) of_rve[k] = static_cast<int>(k % packings);
  Scene scene{.batch = make_batch(std::vector<Packing>(packings, rve.packing), std::move(of_rve)),
              .requests = {},
              .settings = {.precision = precision}};
  for (std::size_t k = 0; k < n; ++k) host::store_rve(rve, scene.batch, k);
  scene.requests.assign(n, {.f_rel = sheared(0.0, increment, 0.0), .strain_steps = strain_steps, .hold_cap = 1000});
  return scene;
}

}  // namespace voussoir::kernels
