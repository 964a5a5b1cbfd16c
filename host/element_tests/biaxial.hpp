#pragma once
/// Drained biaxial tests of packings, and what soil mechanics reads from their curves (method.md §3).

#include <span>
#include <string>
#include <vector>

#include "fem/invariants.hpp"
#include "host/packing/packings.hpp"

namespace voussoir::host {

/// One point of a test; soil mechanics' signs: compression positive.
struct BiaxialPoint {
  double axial_strain;                     ///< logarithmic [-]
  double lateral_strain;                   ///< logarithmic [-]
  double stress_xx, stress_yy, stress_xy;  ///< [Pa]
  double unbalanced;                       ///< [-]

  kernels::Microstructure microstructure = {};  ///< as far as it was asked for; grain rotation since the test's start

  [[nodiscard]] fem::PlaneTensor stress() const {
    return {-stress_xx, -stress_yy, -stress_xy};
  }  ///< tension positive [Pa]
  [[nodiscard]] fem::PlaneTensor strain() const {
    return {-lateral_strain, -axial_strain, 0.0};
  }  ///< extension positive [-]
  [[nodiscard]] double p() const { return fem::mean_stress(stress()); }
  [[nodiscard]] double q() const { return fem::deviatoric_stress(stress()); }
  [[nodiscard]] double volumetric_strain() const { return fem::volumetric_strain(strain()); }
  [[nodiscard]] double shear_strain() const { return fem::deviatoric_strain(strain()); }
};

struct BiaxialCurve {
  std::int64_t seed = 0;
  double pressure = 0;         ///< confining [Pa]
  double void_ratio = 0;       ///< at the start [-]
  double inertial_number = 0;  ///< of the axial rate at the confining pressure [-]
  kernels::RveStatus status = kernels::RveStatus::converged;
  std::vector<BiaxialPoint> points;

  /// Area of voids over area of grains [-]. @param point of this curve
  [[nodiscard]] double void_ratio_at(const BiaxialPoint& point) const {
    return (1.0 + void_ratio) * std::exp(-point.volumetric_strain()) - 1.0;
  }
};

/// Strength and dilatancy of one curve.
struct Strength {
  double peak_angle = 0;       ///< phi_p, sin phi = q/p at its largest [rad]
  double peak_strain = 0;      ///< axial strain there [-]
  double critical_angle = 0;   ///< phi_cs, mean of q/p over the last quarter of the axial strain [rad]
  double dilatancy = 0;        ///< psi_max, sin psi = max(-d eps_v / d eps_q) [rad]
  double contraction = 0;      ///< largest eps_v [-]
  double lateral_error = 0;    ///< |mean of sigma_xx / pressure - 1| [-]
  double lateral_scatter = 0;  ///< root mean square of sigma_xx / pressure - 1 [-]
};

/// All packings in one batch, each compressed along y from its own state, its own pressure held on x. The packing must
/// rest at that pressure already. Throws std::invalid_argument where the rate asks for more than 1e9 steps.
/// @param strain axial, logarithmic [-]; @param inertial_number sets the rate; @param samples points of a curve
/// @param microstructure of each point; nothing is computed unless asked for, and the curve's bits stay the same
[[nodiscard]] std::vector<BiaxialCurve> biaxial_tests(std::span<const PackedRve> rves, double strain,
                                                      double inertial_number, int samples,
                                                      const kernels::EngineSettings& settings,
                                                      const kernels::MicrostructureRequest& microstructure = {});

/// q/p and the slope of eps_v against eps_q are taken over a moving window of axial strain (mean and least-squares
/// line).
[[nodiscard]] Strength strength_of(const BiaxialCurve& curve, double window);

/// p [Pa] where a test under `pressure` [Pa] on x mobilises `angle` [rad].
[[nodiscard]] double mean_stress_at(double pressure, double angle);

/// The test ended as it should and sigma_xx was held, its scatter below a tenth.
[[nodiscard]] bool held(const BiaxialCurve& curve, const Strength& strength);

/// Friction angle of several tests: sin phi is the slope of q against p through the origin, from the angle of each test
/// and its p there.
[[nodiscard]] double common_angle(std::span<const double> angles, std::span<const double> p);

/// `kind = "biaxial"`: curves and strength to run.h5:/tables, a summary to standard output. Returns an exit code.
[[nodiscard]] int run_biaxial(const Case& input, const RunOptions& options);

}  // namespace voussoir::host
