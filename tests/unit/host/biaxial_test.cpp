// Strength and dilatancy read from curves whose answers are known.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "host/element_tests/strength.hpp"

namespace voussoir::host {
namespace {

/// sin phi rises to `peak` at 4 % and falls to `critical` by 10 %; the volume follows eps_v = -sin(psi) eps_q from 2 %
/// on.
BiaxialCurve made_curve(double peak, double critical, double sin_psi) {
  BiaxialCurve curve;
  curve.pressure = 1.0e5;
  double shear = 0, volume = 0;
  for (int k = 0; k <= 2000; ++k) {
    const double axial = 1e-4 * k;
    const double ratio = axial < 0.04   ? peak * std::sin(0.5 * std::numbers::pi * axial / 0.04)
                         : axial < 0.10 ? peak + (critical - peak) * (axial - 0.04) / 0.06
                                        : critical;
    const double slope = axial > 0.02 && axial < 0.10 ? -sin_psi : 0.0;
    // eps_a = (eps_v + eps_q) / 2 with eps_v = slope * eps_q along the step
    const double dq = k == 0 ? 0 : 2e-4 / (1.0 + slope);
    shear += dq;
    volume += slope * dq;
    const double p = curve.pressure / (1.0 - ratio), q = ratio * p;
    curve.points.push_back({0.5 * (volume + shear), 0.5 * (volume - shear), p - q, p + q, 0.0, 1e-4});
  }
  return curve;
}

TEST(Strength, PeakCriticalStateAndDilatancy) {
  const Strength s = strength_of(made_curve(0.63, 0.54, 0.25), 0.01);
  EXPECT_NEAR(std::sin(s.peak_angle), 0.63, 0.004);  // the window rounds the tip
  EXPECT_NEAR(s.peak_strain, 0.04, 0.003);
  EXPECT_NEAR(std::sin(s.critical_angle), 0.54, 1e-11);
  EXPECT_NEAR(std::sin(s.dilatancy), 0.25, 1e-11);
  EXPECT_LT(s.lateral_error, 1e-15);
}

TEST(Strength, AContractingSoilHasNoDilatancyAngle) {
  const Strength s = strength_of(made_curve(0.54, 0.54, -0.1), 0.01);
  EXPECT_NEAR(s.dilatancy, 0.0, 1e-12);
  EXPECT_GT(s.contraction, 0.005);
}

TEST(Strength, ShearStressTurnsMohrsCircle) {
  const BiaxialPoint point{0, 0, 1.0e5, 1.0e5, 3.0e4, 0};
  EXPECT_NEAR(point.q(), 3.0e4, 1e-9);
  EXPECT_NEAR(point.p(), 1.0e5, 1e-9);
}

TEST(Strength, CommonAngleIsTheSlopeThroughTheOrigin) {
  const std::vector<double> angles{std::asin(0.60), std::asin(0.50)}, p{1.0e5, 3.0e5};
  EXPECT_NEAR(std::sin(common_angle(angles, p)), (1 * 0.60 + 9 * 0.50) / 10, 1e-12);
}

TEST(Strength, CommonDilatancyIsTheMeanOfTheSinesWithTheScatterOfTheAngles) {
  const double low = std::asin(0.1), high = std::asin(0.5);
  const CommonDilatancy two = common_dilatancy(std::vector<double>{low, high});
  EXPECT_NEAR(std::sin(two.mean), 0.3, 1e-12);
  EXPECT_NEAR(two.deviation, (high - low) / std::sqrt(2.0), 1e-12);
  const CommonDilatancy one = common_dilatancy(std::vector<double>{high});
  EXPECT_NEAR(one.mean, high, 1e-12);
  EXPECT_EQ(one.deviation, 0.0);
}

TEST(Strength, ACurveTooShortHasNone) { EXPECT_EQ(strength_of({}, 0.01).peak_angle, 0.0); }

}  // namespace
}  // namespace voussoir::host
