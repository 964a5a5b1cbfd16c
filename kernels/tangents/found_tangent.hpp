#pragma once
/// A static tangent in place of that of eq. (4) in a report, where it is usable.

#include "kernels/state/rve_batch.hpp"

namespace voussoir::kernels {

/// Whether a static tangent `d` [Pa] is at most as stiff as the contact tangent. In exact arithmetic every static
/// tangent is softer; a stiffer one shows that rounding has spoilt the iterations. False for NaN. The slack covers the
/// factor y (docs/explanation/tangents.md).
[[nodiscard]] KOKKOS_INLINE_FUNCTION bool is_softer(const double* d, const double* contact) {
  constexpr double slack = 1.05;
  return d[0] <= slack * contact[0] && d[3] <= slack * contact[3] && d[5] <= slack * contact[5];
}

/// A tangent that may take the place of eq. (4) in a report.
struct FoundTangent {
  TangentKind kind;
  double tangent[6];  ///< [Pa]
  double skew[3];     ///< [Pa]
  int iterations;
  bool converged;
};

/// Writes `found` into the report if it is usable. @param contact tangent of eq. (4) [Pa]
KOKKOS_INLINE_FUNCTION void replace_tangent(RveReport& report, const FoundTangent& found, const double* contact) {
  if (!is_softer(found.tangent, contact)) return;
  for (int c = 0; c < 6; ++c) report.tangent[c] = found.tangent[c];
  for (int c = 0; c < 3; ++c) report.tangent_skew[c] = found.skew[c];
  report.tangent_kind = found.kind;
}

}  // namespace voussoir::kernels
