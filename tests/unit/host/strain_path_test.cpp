// RVEs taken along a path of increments, and the state at its end taken up again.
#include "host/element_tests/strain_path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "host/packing/stored_packing.hpp"
#include "tests/host_support.hpp"

namespace voussoir::host {
namespace {

class StrainPath : public testing::Test {
 protected:
  static void SetUpTestSuite() { rve = small_packing(); }

  std::vector<PathPoint> walk(RvePool& pool, const std::vector<PathSegment>& segments,
                              const std::vector<double>& scale) {
    std::vector<PathPoint> points;
    end_ = walk_path(pool, segments, scale, [&](const PathPoint& at) { points.push_back(at); });
    return points;
  }

  static inline PackedRve rve;
  PathEnd end_;
};

TEST_F(StrainPath, AGivenPathIsThatOfSingleEvaluations) {
  RvePool pool(rve, {EngineCase{}}, 1), by_hand(rve, {EngineCase{}}, 1);
  const auto points = walk(pool, {{.gradient = {1e-3, 2e-3, 0, -1e-3}, .increments = 3}}, {1.0});
  ASSERT_TRUE(end_.usable);
  ASSERT_EQ(points.size(), 4u);  // the start, and three increments
  fem::Gradient h;
  h << 1e-3, 2e-3, 0, -1e-3;
  std::vector<fem::Stress> stress(1);
  std::vector<fem::Tangent> tangent(1);
  for (int k = 0; k < 3; ++k) {
    by_hand.begin_increment();
    ASSERT_TRUE(by_hand.evaluate(std::span(&h, 1), stress, tangent).usable);
    by_hand.commit();
  }
  EXPECT_EQ(points.back().stress, stress[0]);
  EXPECT_EQ(pool.state(), by_hand.state()) << "grains, contacts and reports, steps among them";
  EXPECT_NEAR(points.back().strain.xx + points.back().strain.yy, 3 * std::log(1 - 1e-6), 1e-14) << "log det F";
  EXPECT_EQ(points.back().evaluations, 1);
}

// A larger increment takes more steps: each begins anew.
TEST_F(StrainPath, EachIncrementChoosesItsSteps) {
  RvePool pool(rve, PoolOptions{}, 1), by_hand(rve, PoolOptions{}, 1);
  const auto points = walk(pool, {{.gradient = {0, 0, 0, -1e-3}}, {.gradient = {0, 0, 0, -1.7e-3}}}, {1.0});
  ASSERT_TRUE(end_.usable);
  std::vector<fem::Stress> stress(1);
  std::vector<fem::Tangent> tangent(1);
  for (const double strain : {1e-3, 1.7e-3}) {
    fem::Gradient h;
    h << 0, 0, 0, -strain;
    by_hand.begin_increment();
    by_hand.evaluate(std::span(&h, 1), stress, tangent);
    by_hand.commit();
  }
  EXPECT_EQ(points.back().stress, stress[0]);
}

TEST_F(StrainPath, ReplicasAreScaledAndEachFindsItsOwn) {
  const std::vector<double> scale{1.0, 1.3};
  for (const bool held : {false, true}) {
    RvePool pool(rve, PoolOptions{}, 2);
    const auto points = walk(pool, {{.gradient = {0, 0, 0, -1e-3}, .increments = 4, .constant_xx = held}}, scale);
    ASSERT_TRUE(end_.usable);
    EXPECT_EQ(end_.missed, 0);
    for (const PathPoint& at : points) {
      EXPECT_NEAR(at.strain.yy, at.increment * std::log1p(-1e-3 * scale[at.rve]), 1e-14);
      const double start = points[at.rve].stress(0);
      if (held) {
        EXPECT_NEAR(at.stress(0), start, lateral_tolerance * std::abs(start));
      }
    }
    EXPECT_LT(points[points.size() - 1].stress(1), points[points.size() - 2].stress(1))
        << "the second is compressed more";
  }
}

TEST_F(StrainPath, LateralStressIsHeldWhereAsked) {
  RvePool pool(rve, {EngineCase{}}, 2);
  const auto points = walk(pool, {{.gradient = {0, 0, 0, -1e-3}, .increments = 8, .constant_xx = true}}, {1.0, 1.0});
  ASSERT_TRUE(end_.usable);
  for (const PathPoint& at : points) {
    EXPECT_NEAR(at.stress(0), points[0].stress(0), lateral_tolerance * std::abs(points[0].stress(0)));
    EXPECT_LE(at.evaluations, most_evaluations - 1) << "found, not given up";
  }
  const PathPoint& end = points.back();
  EXPECT_NEAR(end.strain.yy, 8 * std::log1p(-1e-3), 1e-14);
  EXPECT_GT(end.strain.xx, 0) << "it bulges";
  EXPECT_LT(end.stress(1), 2 * end.stress(0)) << "and resists";
  EXPECT_EQ(points[points.size() - 1].stress, points[points.size() - 2].stress) << "two clones, one answer";
}

TEST_F(StrainPath, AStressThatIsMissedIsCounted) {
  RvePool pool(rve, {EngineCase{}}, 1), coarse(rve, {EngineCase{}}, 1);
  (void)walk(pool, {{.gradient = {0, 0, 0, -1e-3}, .increments = 8, .constant_xx = true}}, {1.0});
  EXPECT_EQ(end_.missed, 0);
  EXPECT_LE(end_.largest_miss, lateral_tolerance);
  const auto points = walk(coarse, {{.gradient = {0, 0, 0, 0.05}, .increments = 1, .constant_xx = true}}, {1.0});
  ASSERT_TRUE(end_.usable);
  EXPECT_EQ(points.back().evaluations, most_evaluations);
  EXPECT_EQ(end_.missed, 1);
  EXPECT_DOUBLE_EQ(end_.largest_miss, std::abs(points[1].stress(0) / points[0].stress(0) - 1));
}

TEST_F(StrainPath, SegmentsFollowOneAnother) {
  RvePool pool(rve, {EngineCase{}}, 1);
  const auto points = walk(
      pool, {{.gradient = {0, 0, 0, -1e-3}, .increments = 2}, {.gradient = {0, 0, 0, 1e-3}, .increments = 1}}, {1.0});
  ASSERT_EQ(points.size(), 4u);
  EXPECT_EQ(points.back().increment, 3);
  EXPECT_LT(points[2].stress(1), points[0].stress(1)) << "compressed";
  EXPECT_GT(points[3].stress(1), points[2].stress(1)) << "and unloaded";
}

TEST_F(StrainPath, AnImpossibleIncrementEndsIt) {
  RvePool pool(rve, {EngineCase{}}, 1);
  const auto points = walk(
      pool, {{.gradient = {0, 0, 0, -1e-3}, .increments = 2}, {.gradient = {-0.5, 0, 0, -0.5}, .increments = 5}},
      {1.0});
  EXPECT_FALSE(end_.usable);
  EXPECT_NE(end_.message.find("increment 3"), std::string::npos) << end_.message;
  EXPECT_EQ(points.size(), 3u);
}

TEST_F(StrainPath, TheStoredEndIsTheSameState) {
  RvePool pool(rve, {EngineCase{}}, 1);
  (void)walk(pool, {{.gradient = {0, 0, 0, -1e-3}, .increments = 5, .constant_xx = true}}, {1.0});
  const auto stored = restored_packing(stored_packing(pool.packed(0), SoilCase{}, "test", "0"), SoilCase{});
  ASSERT_TRUE(stored.has_value());
  RvePool again(*stored, {EngineCase{}}, 1);
  fem::Gradient h;
  h << 0, 5e-4, 0, -5e-4;
  std::vector<fem::Stress> stress(1), stress_again(1);
  std::vector<fem::Tangent> tangent(1), tangent_again(1);
  pool.begin_increment();
  pool.evaluate(std::span(&h, 1), stress, tangent);
  again.evaluate(std::span(&h, 1), stress_again, tangent_again);
  EXPECT_EQ(stress[0], stress_again[0]);
  EXPECT_EQ(tangent[0], tangent_again[0]);
}

}  // namespace
}  // namespace voussoir::host
