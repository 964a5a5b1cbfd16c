#include <gtest/gtest.h>

#include "fem/linear_elastic.hpp"
#include "tests/throws.hpp"

namespace voussoir::fem {
namespace {

Stress evaluate_one(LinearElastic& material, const Gradient& h) {
  Stress stress;
  Tangent tangent;
  static_cast<void>(material.evaluate({&h, 1}, {&stress, 1}, {&tangent, 1}));
  return stress;
}

TEST(LinearElastic, OedometricModulus) {
  LinearElastic material(1, {.young = 1e7, .poisson = 0.25});
  Gradient h = Gradient::Zero();
  h(1, 1) = -1e-3;
  const Stress s = evaluate_one(material, h);
  EXPECT_NEAR(s[1], -1e7 * 0.75 / (1.25 * 0.5) * 1e-3, 1e-9);
  EXPECT_NEAR(s[0] / s[1], 0.25 / 0.75, 1e-14);
}

TEST(LinearElastic, EvaluatesFromTheCommittedStateOnly) {
  LinearElastic material(1, {});
  Gradient h;
  h << 1e-3, 2e-3, 0, -1e-3;
  const Stress once = evaluate_one(material, h);
  EXPECT_EQ(evaluate_one(material, h), once);
  const std::vector<std::byte> before = material.state();
  material.commit();
  EXPECT_LT((evaluate_one(material, h) - 2 * once).norm(), 1e-9);
  material.set_state(before);
  EXPECT_EQ(evaluate_one(material, h), once);
  expect_throws<std::runtime_error>([&] { material.set_state(std::span(before).first(8)); },
                                    "belongs to another batch");
}

TEST(LinearElastic, LogarithmicStrainLetsARotationTurnTheStressOnly) {
  LinearElastic material(1, {.initial_stress = Stress(-3e4, -1e5, 1e4), .strain = ElasticStrain::logarithmic});
  Eigen::Matrix2d stress;
  stress << -3e4, 1e4, 1e4, -1e5;
  const Eigen::Matrix2d rotation = Eigen::Rotation2Dd(1.1).toRotationMatrix();
  const Stress s = evaluate_one(material, rotation - Eigen::Matrix2d::Identity());
  const Eigen::Matrix2d expected = rotation * stress * rotation.transpose();
  EXPECT_LT((s - Stress(expected(0, 0), expected(1, 1), expected(0, 1))).norm(), 1e-8);
}

TEST(LinearElastic, ImpossibleConstantsAreRefused) {
  expect_throws<std::invalid_argument>([&] { LinearElastic(1, {.young = 0}); }, "Young's modulus");
  expect_throws<std::invalid_argument>([&] { LinearElastic(1, {.poisson = 0.5}); }, "Poisson's ratio");
}

}  // namespace
}  // namespace voussoir::fem
