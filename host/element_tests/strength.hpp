#pragma once
/// Strength and dilatancy from the curves of drained biaxial tests.

#include <span>

#include "host/element_tests/biaxial.hpp"

namespace voussoir::host {

/// Strength and dilatancy of one curve.
struct Strength {
  double peak_angle = 0;       ///< phi_p, sin phi = q/p at its largest [rad]
  double peak_strain = 0;      ///< axial strain at the largest q/p [-]
  double critical_angle = 0;   ///< phi_cs, mean of q/p over the last quarter of the axial strain [rad]
  double dilatancy = 0;        ///< psi_max, sin psi = max(-d eps_v / d eps_q) [rad]
  double contraction = 0;      ///< largest eps_v [-]
  double lateral_error = 0;    ///< |mean of sigma_xx / pressure - 1| [-]
  double lateral_scatter = 0;  ///< root mean square of sigma_xx / pressure - 1 [-]
  double late_rise = 0;        ///< mean q/p of the last quarter of the axial strain over that of the third, less 1 [-]
};

/// Reads strength and dilatancy from a curve. Within a moving window of axial strain q/p is averaged, and the slope of
/// eps_v against eps_q is that of a least-squares line.
[[nodiscard]] Strength strength_of(const BiaxialCurve& curve, double window);

/// The mean stress p [Pa] at which a test under `pressure` [Pa] on x mobilises the friction angle `angle` [rad].
[[nodiscard]] double mean_stress_at(double pressure, double angle);

/// The scatter of sigma_xx [-] above which a test is not one at a constant lateral stress.
inline constexpr double most_lateral_scatter = 0.1;

/// The rise of q/p from the third to the last quarter of a test [-] above which the test ended before its peak. Tests
/// to 20 % end on their critical state or, of loose packings, on a plateau.
inline constexpr double most_late_rise = 0.15;

/// True if the test reached its end, sigma_xx was held (most_lateral_scatter), the strength did not rise any more
/// (most_late_rise), and the overlaps stayed within what the contact law is good for (packing/law_range.hpp).
[[nodiscard]] bool held(const BiaxialCurve& curve, const Strength& strength);

/// Friction angle of several tests: sin phi is the slope of a line q against p through the origin, fitted to each
/// test's angle and the p [Pa] at which the test had that angle.
[[nodiscard]] double common_angle(std::span<const double> angles, std::span<const double> p);

/// The dilatancy of several tests.
struct CommonDilatancy {
  double mean = 0;       ///< its sine is the mean of the tests' sines, which are ratios of strains as they are [rad]
  double deviation = 0;  ///< standard deviation of the tests' angles; 0 with fewer than two tests [rad]
};
/// @param angles the largest dilatancy of each test, at least one [rad]
[[nodiscard]] CommonDilatancy common_dilatancy(std::span<const double> angles);

}  // namespace voussoir::host
