// The limits beyond which overlaps are not small, and what packings that pass them are called.
#include "host/packing/law_range.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>

#include "host/element_tests/strength.hpp"
#include "host/packing/recipe.hpp"

namespace voussoir::host {
namespace {

PackedRve packing_at(double pressure) {
  const std::int64_t seed[] = {1};
  PackingCase recipe;
  recipe.grains = 60;
  recipe.pressure = pressure;
  return make_packings({}, recipe, seed).front();
}

TEST(LawRange, EqualDiscsAreDensestOnTheHexagonalLattice) {
  EXPECT_NEAR(least_void_ratio(1.0), 2 * std::sqrt(3.0) / std::numbers::pi - 1, 1e-12);
  EXPECT_NEAR(least_void_ratio(2.375), 0.0865, 5e-4);
  for (double ratio = 1; ratio < 40; ratio *= 1.5) EXPECT_LT(least_void_ratio(1.5 * ratio), least_void_ratio(ratio));
  EXPECT_GT(least_void_ratio(1e6), 0.0);
}

// Up to 800 kPa packings of the default soil are within the range; at 10 MPa their grains interpenetrate.
TEST(LawRange, PackingsUpTo800KilopascalAreWithinIt) {
  for (const double pressure : {1e3, 1e5, 8e5}) {
    const PackedRve rve = packing_at(pressure);
    ASSERT_EQ(rve.status, kernels::RveStatus::converged) << pressure;
    EXPECT_EQ(interpenetration(rve), "") << pressure;
    EXPECT_LT(rve.mean_overlap, 0.5 * most_mean_overlap) << pressure;
    const double kappa = stiffness_number(rve.packing, pressure);
    EXPECT_NEAR(foretold_overlap(kappa) / rve.mean_overlap, 1.0, 0.25) << pressure;  // 60 grains scatter by 10 %
  }
  const PackedRve crushed = packing_at(1e7);
  EXPECT_NE(interpenetration(crushed).find("interpenetrate"), std::string::npos) << crushed.void_ratio;
  EXPECT_GT(crushed.mean_overlap, most_mean_overlap);
  EXPECT_GT(foretold_overlap(stiffness_number(crushed.packing, 1e7)), most_mean_overlap);
}

// The table of docs/explanation/range.md: mean overlap and void ratio at 1 and 5 MPa.
TEST(LawRange, IsForetoldAsMeasured) {
  EXPECT_NEAR(foretold_overlap(50.6), 0.0153, 0.001);
  EXPECT_NEAR(foretold_overlap(10.1), 0.0603, 0.003);
  EXPECT_NEAR(foretold_void_ratio(0.1843, 0.0153), 0.1309, 0.005);
  EXPECT_NEAR(foretold_void_ratio(0.1843, 0.0603), 0.0017, 0.005);
}

// With k_n = E r of equal grains and t = 0.1 m, kappa is E r / (p t).
TEST(LawRange, TheStiffnessNumberIsThatOfEqualGrains) {
  kernels::Packing packing;
  packing.radii.assign(10, 1e-3);
  EXPECT_NEAR(stiffness_number(packing, 1e5), 3e9 * 1e-3 / (1e5 * 0.1), 1e-9);
}

TEST(LawRange, ATestBeyondItDoesNotHold) {
  BiaxialCurve curve;
  curve.mean_overlap = most_mean_overlap;
  EXPECT_TRUE(held(curve, {}));
  EXPECT_TRUE(held(curve, {.late_rise = 0.9 * most_late_rise}));
  EXPECT_FALSE(held(curve, {.late_rise = 1.1 * most_late_rise})) << "a test that ends before its peak has no strength";
  curve.mean_overlap *= 1.01;
  EXPECT_FALSE(held(curve, {}));
}

}  // namespace
}  // namespace voussoir::host
