#pragma once
/// Helpers of the engine's tests: batches made from the oracle's packings.

#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "kernels/advance_rves.hpp"
#include "tests/reference/reference_packing.hpp"

namespace voussoir::kernels {

inline reference::Mat2 plain(const Mat2& m) { return {m.xx, m.xy, m.yx, m.yy}; }

inline Packing packing_of(const reference::Rve& rve) {
  const reference::Material& m = rve.material;
  return {.radii = rve.radii,
          .materials = {{.modulus = m.modulus,
                         .stiffness_ratio = m.stiffness_ratio,
                         .friction = m.friction,
                         .rolling_stiffness = m.rolling_stiffness,
                         .rolling_limit = m.rolling_limit}},
          .class_of = {},
          .thickness = m.thickness,
          .local_damping = m.damping};
}

inline void fill(RveStates& states, std::size_t rve, const reference::Rve& from) {
  const reference::Mat2 inverse = reference::inverse(from.cell);
  for (std::size_t i = 0; i < from.radii.size(); ++i) {
    const reference::Vec2 f = inverse * from.positions[i];
    const reference::Vec2 x = from.cell * reference::Vec2{f.x - std::floor(f.x), f.y - std::floor(f.y)};
    states.position(rve, i, 0) = x.x;
    states.position(rve, i, 1) = x.y;
    states.rotation(rve, i) = from.rotations[i];
  }
  const double cell[4] = {from.cell.xx, from.cell.xy, from.cell.yx, from.cell.yy};
  for (std::size_t k = 0; k < 4; ++k) states.cell(rve, k) = cell[k];
  static_assert(history_size<PlainEngineLaw> == 2, "the oracle remembers the two numbers of the linear law");
  int count = 0;
  for (const auto& [pair, history] : from.histories) {
    states.contact_key(rve, count) = pair_key(pair.first, pair.second);
    states.contact_history(rve, count, 0) = history.tangential;
    states.contact_history(rve, count, 1) = history.moment;
    ++count;
  }
  states.contact_count(rve) = count;
}

inline RveBatch clones(const reference::Rve& rve, std::size_t n) {
  RveBatch batch = make_batch({packing_of(rve)}, std::vector<int>(n, 0));
  for (std::size_t k = 0; k < n; ++k) fill(batch.committed, k, rve);
  return batch;
}

inline EngineSettings in_double() { return {.precision = Precision::float64}; }

/// The same with a lower limit of overlaps, which violent motions meet on their way.
inline EngineSettings with_low_limit(EngineSettings settings) {
  settings.overlap_limit = 0.3;
  return settings;
}

inline std::vector<RveReport> run(RveBatch& batch, const std::vector<StrainRequest>& requests,
                                  const EngineSettings& settings) {
  std::vector<RveReport> reports(batch.size());
  advance(batch, std::span<const StrainRequest>(requests), settings, reports);
  return reports;
}

/// The first of a batch whose committed states are left as they are.
inline RveReport at_rest(RveBatch& batch, const EngineSettings& settings) {
  return run(batch, std::vector(batch.size(), StrainRequest{.hold_cap = 1}), settings).front();
}

/// One motion of `rve` alone and in a group of 19: number 7 moves alike, the others otherwise; 3 has a position that is
/// not a number, 4 is pulled open.
struct AloneAndInAGroup {
  RveReport alone;
  std::vector<RveReport> group;
};

inline AloneAndInAGroup run_alone_and_in_a_group(const reference::Rve& rve, const EngineSettings& settings) {
  const StrainRequest general{.f_rel = {1.0004, 0.0012, -0.0005, 0.9994}, .strain_steps = 300, .hold_cap = 60};
  RveBatch alone = clones(rve, 1), batch = clones(rve, 19);
  std::vector<StrainRequest> requests(19, general);
  for (std::size_t k = 0; k < 19; ++k) {
    if (k == 7) continue;
    const double e = 2e-3 * std::cos(1.0 * static_cast<double>(k));
    requests[k].f_rel = {1 + 3 * e, 3 * e, -e, 1 - 2 * e};
  }
  requests[4].f_rel = {1.2, 0, 0, 1.2};
  batch.committed.position(3, 3, 0) = std::numeric_limits<double>::quiet_NaN();
  return {run(alone, {general}, settings).front(), run(batch, requests, settings)};
}

}  // namespace voussoir::kernels
