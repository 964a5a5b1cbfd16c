// RVEs as the material of a mesh: the number of steps that an increment gets, and what a snapshot shows.
#include "host/material/rve_pool.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/host_support.hpp"

namespace voussoir::host {
namespace {

/// The steps are the smallest number of the series ceil(1.25^k) that is not below the wanted number.
TEST(RvePool, StepsAreTheNextOfTheirSeries) {
  const PackedRve rve = small_packing();
  EngineCase engine;
  engine.hold_cap = 0;
  engine.minimum_steps = 1;
  RvePool pool(rve, {.engine = engine}, 1);
  const double time = rve.packing.inertial_time(pool.committed_reports()[0].pressure());
  std::vector<fem::Stress> stress(1);
  for (const double strain : {1e-7, 1e-5, 3e-5, 1e-4, 3e-4, 1e-3}) {
    fem::Gradient h = fem::Gradient::Zero();
    h(0, 0) = -strain;
    pool.begin_increment();
    ASSERT_TRUE(pool.evaluate({&h, 1}, stress, {}).usable);
    const double wanted = -std::log1p(-strain) / engine.inertial_number * time;
    double power = 1;
    while (power < wanted) power *= 1.25;
    // The engine looks at the forces once more where the hold would begin, which counts as a step.
    EXPECT_EQ(pool.trial_reports()[0].steps, static_cast<int>(std::ceil(power)) + 1) << strain;
  }
}

TEST(RvePool, TellsTheTimeOfTheTangentsThatAreWanted) {
  RvePool pool(small_packing(), {.engine = {}, .tangent = kernels::TangentKind::elastic}, 1);
  const fem::Gradient none = fem::Gradient::Zero();
  std::vector<fem::Stress> stress(1);
  std::vector<fem::Tangent> tangent(1);
  EXPECT_GT(pool.evaluate({&none, 1}, stress, tangent).tangent_time, 0.0);
  EXPECT_EQ(pool.evaluate({&none, 1}, stress, {}).tangent_time, 0.0);
}

TEST(RvePool, ASnapshotShowsTheGrainsWhereTheyAre) {
  const PackedRve rve = small_packing();
  const RvePool pool(rve, {}, 2);
  const std::vector<std::int64_t> points{1};
  const io::RveSnapshot shown = pool.snapshots(points).at(0);
  ASSERT_EQ(shown.x.size(), rve.packing.radii.size());
  for (std::size_t i = 0; i < shown.x.size(); ++i) {
    EXPECT_EQ(shown.x[i], rve.position[2 * i]);
    EXPECT_EQ(shown.y[i], rve.position[2 * i + 1]);
    EXPECT_EQ(shown.radius[i], rve.packing.radii[i]);
  }
}

}  // namespace
}  // namespace voussoir::host
