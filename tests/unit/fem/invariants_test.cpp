// Eqs. (7), (8), (10), (11) and the direction of the major compression.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fem/invariants.hpp"

namespace voussoir::fem {
namespace {

TEST(Invariants, StressByHand) {
  const PlaneTensor s(-100.0, -300.0, 0.0);
  EXPECT_DOUBLE_EQ(mean_stress(s), 200.0);
  EXPECT_DOUBLE_EQ(deviatoric_stress(s), 100.0);
  EXPECT_DOUBLE_EQ(deviatoric_stress(PlaneTensor(-50, -50, 30)), 30.0);
}

TEST(Invariants, StrainByHand) {
  EXPECT_DOUBLE_EQ(volumetric_strain(PlaneTensor(0.01, -0.03, 0)), 0.02);
  EXPECT_DOUBLE_EQ(deviatoric_strain(PlaneTensor(0.01, -0.03, 0)), 0.04);
  EXPECT_DOUBLE_EQ(deviatoric_strain(PlaneTensor(0, 0, 0.01)), 0.02);
}

/// eqs. (8) and (11) with their tensors written out.
TEST(Invariants, AgreeWithTheTensorForms) {
  Eigen::Matrix2d t;
  t << 0.3, -0.7, -0.7, -1.1;
  const PlaneTensor v(t(0, 0), t(1, 1), t(0, 1));
  const Eigen::Matrix2d deviator = t - 0.5 * t.trace() * Eigen::Matrix2d::Identity();
  EXPECT_NEAR(deviatoric_stress(v), std::sqrt(0.5 * deviator.squaredNorm()), 1e-15);
  EXPECT_NEAR(deviatoric_strain(v), std::sqrt(2.0 * deviator.squaredNorm()), 1e-15);
}

/// A vertical major compression turned counter-clockwise by an angle.
TEST(Invariants, MajorAxisFollowsARotation) {
  for (const double angle : {-1.2, -0.4, -0.05, 0.0, 0.1, 0.7, 1.5}) {
    const Eigen::Rotation2Dd turn(angle);
    Eigen::Matrix2d s = Eigen::Vector2d(-40.0, -100.0).asDiagonal();
    s = turn.toRotationMatrix() * s * turn.toRotationMatrix().transpose();
    EXPECT_NEAR(major_axis_from_vertical({s(0, 0), s(1, 1), s(0, 1)}), angle, 1e-12);
  }
}

}  // namespace
}  // namespace voussoir::fem
