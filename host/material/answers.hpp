#pragma once
/// The engine's reports in the form that fem takes. The order of the sums does not depend on the ranks on which the
/// RVEs ran, so that the bits are the same.

#include <span>

#include "fem/retired_points.hpp"
#include "kernels/state/rve_batch.hpp"

namespace voussoir::host {

[[nodiscard]] fem::Stress stress_of(const kernels::RveReport& report);

/// The symmetric tangent [Pa], which fem is given.
[[nodiscard]] fem::Tangent tangent_of(const kernels::RveReport& r);

/// The tangent with its antisymmetric part, which only loading tangents have: rows by stress, columns by strain [Pa].
[[nodiscard]] fem::Tangent whole_tangent_of(const kernels::RveReport& r);

/// Copies stresses [Pa] and tangents [Pa] of the reports. The spans have one entry a report; an empty `tangent` is left
/// as it is.
void copy_answers(std::span<const kernels::RveReport> reports, std::span<fem::Stress> stress,
                  std::span<fem::Tangent> tangent);

/// What a report of a whole evaluation depends on, besides the reports of its RVEs.
struct PoolFacts {
  double pressure_floor = 0;             ///< the engine's unbalanced ratios are relative to at least this pressure [Pa]
  std::span<const double> least_areas;   ///< (RVE) cell area below which its grains interpenetrate [m^2], least_areas()
  std::span<const std::size_t> numbers;  ///< (RVE) its number in messages; empty: its number in the pool
  const fem::RetiredPoints& retired;     ///< they are left out
};

/// The report of a whole evaluation, made from the reports of its RVEs. The caller sets `work` and `deferral_error`.
[[nodiscard]] fem::BatchReport summarise(std::span<const kernels::RveReport> reports, const PoolFacts& pool);

}  // namespace voussoir::host
