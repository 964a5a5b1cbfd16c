#pragma once
/// Invariants of plane stress and strain tensors (xx, yy, xy), tension positive, as reports give them.

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

namespace voussoir::fem {

using PlaneTensor = Eigen::Vector3d;  ///< (xx, yy, xy), tensor components

/// p = -1/2 sigma_ii, eq. (7) [Pa], compression positive.
[[nodiscard]] inline double mean_stress(const PlaneTensor& s) { return -0.5 * (s[0] + s[1]); }

/// q = sqrt(1/2 s_ij s_ij), eq. (8) [Pa]: the radius of Mohr's circle.
[[nodiscard]] inline double deviatoric_stress(const PlaneTensor& s) { return std::hypot(0.5 * (s[0] - s[1]), s[2]); }

/// eps_v = -eps_ii, eq. (10) [-], contraction positive.
[[nodiscard]] inline double volumetric_strain(const PlaneTensor& e) { return -(e[0] + e[1]); }

/// eps_q = sqrt(2 e_ij e_ij), eq. (11) [-]: the diameter of Mohr's circle of strain.
[[nodiscard]] inline double deviatoric_strain(const PlaneTensor& e) {
  return 2.0 * std::hypot(0.5 * (e[0] - e[1]), e[2]);
}

/// Angle of the compressive major axis from the vertical [rad], in (-pi/2, pi/2], counter-clockwise positive.
[[nodiscard]] inline double major_axis_from_vertical(const PlaneTensor& s) {
  // The major compression lies at half the angle of Mohr's circle of -sigma, counted from x; from y it is pi/2 less.
  const double from_x = 0.5 * std::atan2(-2.0 * s[2], s[1] - s[0]);
  const double angle = from_x - 0.5 * std::numbers::pi;
  return angle <= -0.5 * std::numbers::pi ? angle + std::numbers::pi : angle;
}

}  // namespace voussoir::fem
