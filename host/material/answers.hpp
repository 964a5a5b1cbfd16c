#pragma once
/// The engine's reports as fem sees them: the same sums in the same order, wherever the RVEs were run.

#include <span>

#include "fem/material_batch.hpp"
#include "kernels/state/rve_batch.hpp"

namespace voussoir::host {

[[nodiscard]] fem::Stress stress_of(const kernels::RveReport& report);

/// The symmetric tangent [Pa], which is the one that fem is given.
[[nodiscard]] fem::Tangent tangent_of(const kernels::RveReport& r);

/// With its antisymmetric part, which loading tangents have: rows by stress, columns by strain [Pa].
[[nodiscard]] fem::Tangent whole_tangent_of(const kernels::RveReport& r);

/// Stresses [Pa] and tangents [Pa] of the reports; all spans have the same length, or `tangent` none.
void copy_answers(std::span<const kernels::RveReport> reports, std::span<fem::Stress> stress,
                  std::span<fem::Tangent> tangent);

/// What a whole evaluation says of itself, but for its work. @param pressure_floor of the engine's ratios [Pa]
[[nodiscard]] fem::BatchReport summarise(std::span<const kernels::RveReport> reports, double pressure_floor);

}  // namespace voussoir::host
