#pragma once
/// Drained biaxial tests of packings; strength.hpp reads strength and dilatancy from their curves.

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "fem/invariants.hpp"
#include "host/packing/packed_rve.hpp"
#include "kernels/advance_rves.hpp"

namespace voussoir::host {

/// One point of a test, in the signs of soil mechanics: compression is positive.
struct BiaxialPoint {
  double axial_strain;                     ///< logarithmic [-]
  double lateral_strain;                   ///< logarithmic [-]
  double stress_xx, stress_yy, stress_xy;  ///< [Pa]
  double unbalanced;                       ///< [-]

  kernels::Microstructure microstructure = {};  ///< the requested part of it; grain rotation since the test's start

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
  double pressure = 0;         ///< confining pressure [Pa]
  double void_ratio = 0;       ///< at the start [-]
  double inertial_number = 0;  ///< inertial number of the axial rate at the confining pressure [-]
  /// The mean overlap over r_i + r_j at the largest mean stress: that of the test's end, in proportion to the stress,
  /// because contacts only become fewer after the peak [-].
  double mean_overlap = 0;
  kernels::RveStatus status = kernels::RveStatus::converged;
  std::vector<BiaxialPoint> points;

  /// Area of voids over area of grains [-]. @param point a point of this curve
  [[nodiscard]] double void_ratio_at(const BiaxialPoint& point) const {
    return (1.0 + void_ratio) * std::exp(-point.volumetric_strain()) - 1.0;
  }
};

/// Tests all packings in one batch. Each is compressed along y from its own state while its own pressure is held on x;
/// it must already be at rest under this pressure. Throws io::InputError where the rate asks for more than 1e9
/// steps.
/// @param strain axial, logarithmic [-]; @param inertial_number sets the rate; @param samples points of a curve
/// @param microstructure the quantities of the contact network that each point gets; they do not change the curve
[[nodiscard]] std::vector<BiaxialCurve> biaxial_tests(std::span<const PackedRve> rves, double strain,
                                                      double inertial_number, int samples,
                                                      const kernels::EngineSettings& settings,
                                                      const kernels::MicrostructureRequest& microstructure = {});

}  // namespace voussoir::host
