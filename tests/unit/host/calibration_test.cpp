// The search of a calibration, on a soil whose answers are a formula.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "host/element_tests/calibrate_tests.hpp"
#include "host/element_tests/calibration.hpp"

namespace voussoir::host {
namespace {

/// Lists of a box whose middle is (0.1, 0.6, 0.1).
CalibrateCase lists() {
  CalibrateCase out;
  out.rolling_stiffness = {0.05, 0.1, 0.2};
  out.thickness = {0.05, 0.1, 0.2};
  return out;
}

SoilCase soil_of(double beta, double eta, double t) {
  SoilCase soil;
  soil.rolling_stiffness = beta;
  soil.rolling_limit = eta;
  soil.thickness = t;
  return soil;
}

/// Angles that are quadratics of the logarithms and meet all targets at beta = 0.13, t = 0.08.
Measured made_soil(const ParameterSet& set, const CalibrateCase& targets) {
  const double b = std::log2(set[Parameter::rolling_stiffness] / 0.13), t = std::log2(set[Parameter::thickness] / 0.08);
  return {set,
          {targets.peak.value + 0.04 * b - 0.02 * t + 0.003 * b * b, targets.critical.value + 0.03 * b + 0.02 * t,
           targets.dilatancy.value - 0.02 * t + 0.004 * b * t, 0.035 + 0.005 * t}};
}

TEST(Calibration, MisfitCountsTolerances) {
  CalibrateCase targets;
  const Observation met{targets.peak.value, targets.critical.value, targets.dilatancy.value, 0.03};
  EXPECT_NEAR(misfit(met, targets), 0.0, 1e-20);
  Observation off = met;
  off[Observable::peak_angle] += 2 * targets.peak.tolerance;
  off[Observable::dilatancy_angle] -= targets.dilatancy.tolerance;
  off[Observable::peak_strain] = targets.peak_strain_maximum + 3 * targets.peak_strain_tolerance;
  EXPECT_NEAR(misfit(off, targets), 4 + 1 + 9, 1e-9);
}

TEST(Calibration, TheGridIsAllCombinationsAndTheRestStays) {
  const SearchBox box(lists(), soil_of(1.0, 0.6, 0.1));
  EXPECT_EQ(box.dimensions(), 2U);
  const auto grid = box.grid();
  ASSERT_EQ(grid.size(), 9U);
  for (const ParameterSet& set : grid) EXPECT_EQ(set[Parameter::rolling_limit], 0.6);
  const std::vector<double> middle{0.5, 0.5};
  EXPECT_NEAR(box.set_at(middle)[Parameter::rolling_stiffness], 0.1, 1e-12);
  EXPECT_NEAR(box.place_of(box.set_at(middle))[1], 0.5, 1e-12);
}

TEST(Calibration, TheSurfaceFindsTheOptimumOfASmoothSoil) {
  const CalibrateCase targets = lists();
  const SearchBox box(targets, soil_of(1.0, 0.6, 0.1));
  std::vector<Measured> measured;
  std::vector<ParameterSet> next = box.grid();
  Optimum best;
  for (int round = 0; round <= 2; ++round) {
    for (const ParameterSet& set : next) measured.push_back(made_soil(set, targets));
    best = find_optimum(box, measured, targets, round);
    next = around(box, best.set, round + 1);
    EXPECT_LE(next.size(), 5U);
  }
  EXPECT_NEAR(best.set[Parameter::rolling_stiffness] / 0.13, 1.0, 0.03);
  EXPECT_NEAR(best.set[Parameter::thickness] / 0.08, 1.0, 0.03);
  EXPECT_LT(best.scatter[Observable::peak_angle], 1e-9);  // quadratics are met exactly
  EXPECT_NEAR(best.per_doubling[Parameter::rolling_stiffness][Observable::critical_angle], 0.03, 1e-6);
  EXPECT_NEAR(best.per_doubling[Parameter::thickness][Observable::peak_strain], 0.005, 1e-6);
  EXPECT_EQ(best.per_doubling[Parameter::rolling_limit][Observable::peak_angle], 0.0);
}

TEST(Calibration, TheSurfaceIsThatOfItsNeighbourhood) {
  CalibrateCase lists_of_one;
  for (int k = 0; k <= 20; ++k) lists_of_one.thickness.push_back(0.05 * std::pow(4.0, k / 20.0));
  const SearchBox box(lists_of_one, soil_of(1.0, 0.6, 0.1));
  const auto steep = [](double x) { return std::pow(x, 6); };  // no quadratic
  std::vector<Measured> points;
  for (const ParameterSet& set : box.grid()) points.push_back({set, {steep(box.place_of(set)[0]), 0, 0, 0}});
  const std::vector<double> center{0.3};
  const auto miss = [&](double range) {
    return std::abs(ResponseSurface(box, points, center, range).at(center)[Observable::peak_angle] - steep(center[0]));
  };
  EXPECT_LT(miss(0.2), 0.2 * miss(100.0));
}

TEST(Calibration, NoStepLeavesTheBox) {
  const SearchBox box(lists(), soil_of(1.0, 0.6, 0.1));
  for (const ParameterSet& set : around(box, {0.2, 0.6, 0.05}, 1)) {
    EXPECT_LE(set[Parameter::rolling_stiffness], 0.2 * (1 + 1e-12));
    EXPECT_GE(set[Parameter::thickness], 0.05 * (1 - 1e-12));
  }
  EXPECT_EQ(around(box, {0.2, 0.6, 0.05}, 1).size(), 3U);  // a corner: the corner and a step along each side
}

/// Three seeds at two pressures; seed k reaches k / 10 of friction, and the seeds of `lost` lose their second test.
SetTests three_seeds(const std::vector<std::int64_t>& lost) {
  SetTests tests;
  for (const double pressure : {1e5, 2e5}) {
    for (const std::int64_t seed : {1, 2, 3}) {
      BiaxialCurve curve;
      curve.seed = seed;
      curve.pressure = pressure;
      const bool is_lost = pressure == 2e5 && std::ranges::find(lost, seed) != lost.end();
      curve.status = is_lost ? kernels::RveStatus::overlap_limit : kernels::RveStatus::converged;
      tests.curves.push_back(curve);
      Strength strength;
      strength.peak_angle = 0.1 * static_cast<double>(seed);
      strength.contraction = 0.01 * static_cast<double>(seed);
      tests.strengths.push_back(strength);
    }
  }
  summarise(tests, {1, 2, 3}, {1e5, 2e5});
  return tests;
}

TEST(Calibration, APackingThatLosesATestIsLeftOutWhole) {
  const SetTests all = three_seeds({}), two = three_seeds({3}), one = three_seeds({1, 3});
  EXPECT_TRUE(all.usable());
  EXPECT_NEAR(all.mean[Observable::peak_angle], 0.2, 1e-12);
  EXPECT_TRUE(two.usable());
  EXPECT_EQ(two.held_seeds, (std::vector<std::int64_t>{1, 2}));
  EXPECT_NEAR(two.mean[Observable::peak_angle], 0.15, 1e-12);
  EXPECT_NEAR(two.deviation[Observable::peak_angle], 0.1 / std::sqrt(2.0), 1e-12);
  ASSERT_EQ(two.contraction.size(), 2U);
  EXPECT_NEAR(two.contraction[0], 0.015, 1e-12);
  EXPECT_FALSE(one.usable());
}

TEST(Calibration, ClassesKeepTheirRatios) {
  SoilCase soil = soil_of(1.0, 0.6, 0.1);
  soil.classes = {{.size_to = 0.02, .rolling_stiffness = 1.0, .rolling_limit = 0.6},
                  {.size_to = 0.04, .rolling_stiffness = 2.0, .rolling_limit = 0.8}};
  const SoilCase other = with_parameters(soil, {0.1, 0.3, 0.2});
  EXPECT_DOUBLE_EQ(other.classes[0].rolling_stiffness, 0.1);
  EXPECT_DOUBLE_EQ(other.classes[1].rolling_stiffness, 0.2);
  EXPECT_DOUBLE_EQ(other.classes[1].rolling_limit, 0.4);
  EXPECT_EQ(other.thickness, 0.2);
}

}  // namespace
}  // namespace voussoir::host
