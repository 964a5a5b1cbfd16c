// The team kernel against the lanes, which are tested against the oracle: the same bits of everything, whatever the
// team's size.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <vector>

#include "kernels/teams/advance_teams.hpp"
#include "tests/engine_support.hpp"
#include "tests/same_answers.hpp"
#include "tests/throws.hpp"

namespace voussoir::kernels {
namespace {

/// On CPUs, one thread either way: several wait for each other at every barrier, milliseconds each where other
/// processes have their cores. Only the shortest test has them.
const std::vector<int> one_thread{0, 1};

class TeamKernel : public testing::Test {
 protected:
  static void SetUpTestSuite() { dense = reference::consolidated_packing(40, 2, 1e5, 0.0, reference::Material{}); }
  static inline reference::Rve dense;
};

reference::Rve gas(int grains, double smallest, double largest) {
  reference::Rve rve = reference::loose_packing(grains, smallest, largest, 4, reference::Material{});
  rve.rotations.assign(rve.radii.size(), 0.0);
  return rve;
}

/// Advances copies of a batch by lanes and by teams, and compares all they answer.
/// @param make () -> RveBatch, the same at each call
template <class Make, class Request>
std::vector<RveReport> expect_lanes_bits(const Make& make, const std::vector<Request>& requests,
                                         EngineSettings settings, const std::vector<int>& team_sizes = one_thread) {
  const auto run = [&](Backend backend, int team_size, RveBatch& batch) {
    settings.backend = backend;
    settings.team_size = team_size;
    std::vector<RveReport> reports(batch.size());
    advance(batch, std::span<const Request>(requests), settings, reports);
    return reports;
  };
  RveBatch lanes = make();
  const std::vector<RveReport> expected = run(Backend::lanes, 0, lanes);
  for (const int size : team_sizes) {
    SCOPED_TRACE(testing::Message() << "team of " << size);
    RveBatch teams = make();
    const std::vector<RveReport> reports = run(Backend::teams, size, teams);
    for (std::size_t k = 0; k < lanes.size(); ++k) {
      expect_same_report(reports[k], expected[k], k);
      expect_same_state(teams.trial, lanes.trial, k, lanes.packing(k).radii.size());
    }
  }
  return expected;
}

const StrainRequest general{.f_rel = {1.0004, 0.0012, -0.0005, 0.9994}, .strain_steps = 300, .hold_cap = 60};

/// Different motions, so that teams end at different steps.
std::vector<StrainRequest> motions(std::size_t n) {
  std::vector<StrainRequest> requests(n);
  for (std::size_t k = 0; k < n; ++k) {
    const double e = 1e-3 * std::cos(1.0 * static_cast<double>(k));
    requests[k] = {
        .f_rel = {1 + e, 3 * e, -e, 1 - 2 * e}, .strain_steps = 100 + 20 * static_cast<int>(k), .hold_cap = 200};
  }
  return requests;
}

TEST_F(TeamKernel, HasTheLanesBits) {
  for (const Precision precision : {Precision::float32, Precision::float64}) {
    SCOPED_TRACE(static_cast<int>(precision));
    const auto reports = expect_lanes_bits([&] { return clones(dense, 6); }, motions(6), {.precision = precision});
    for (const RveReport& r : reports) EXPECT_FALSE(is_failure(r.status));
  }
}

TEST_F(TeamKernel, HasTheLanesBitsWithSeveralThreadsToATeam) {
  std::vector<int> sizes;
  for (int size = 2; size <= std::min(Kokkos::DefaultExecutionSpace().concurrency(), 4); ++size) sizes.push_back(size);
  if (sizes.empty()) GTEST_SKIP() << "one thread";
  EngineSettings settings;
  settings.skin = 0.0005;
  settings.list_interval = 1;
  const StrainRequest short_one{.f_rel = {1.001, 0.003, -0.001, 0.998}, .strain_steps = 16, .hold_cap = 4};
  expect_lanes_bits([&] { return clones(dense, 1); }, std::vector{short_one}, settings, sizes);
}

TEST_F(TeamKernel, HasTheLanesBitsThroughManyRebases) {
  EngineSettings settings = in_double();
  settings.skin = 0.0005;
  settings.list_interval = 1;
  expect_lanes_bits([&] { return clones(dense, 3); }, motions(3), settings);
}

TEST_F(TeamKernel, HasTheLanesBitsInTheNextIncrementToo) {
  for (const Precision precision : {Precision::float32, Precision::float64}) {
    const auto make = [&] {
      RveBatch batch = clones(dense, 3);
      run(batch, motions(3), {.precision = precision, .backend = Backend::teams});
      commit(batch);
      return batch;
    };
    expect_lanes_bits(make, std::vector(3, general), {.precision = precision});
  }
}

TEST_F(TeamKernel, HasTheLanesBitsWithoutRolling) {
  reference::Rve rve = dense;
  rve.material.rolling_stiffness = 0;
  for (auto& [pair, history] : rve.histories) history.moment = 0;
  expect_lanes_bits([&] { return clones(rve, 2); }, motions(2), EngineSettings{});
}

TEST_F(TeamKernel, HasTheLanesBitsWithClassesAndUnlikePackings) {
  const reference::Rve other = reference::consolidated_packing(30, 5, 1e5, 0.0, reference::Material{});
  const auto make = [&] {
    Packing mixed = packing_of(dense);
    mixed.materials.push_back(
        {.modulus = 5e9, .stiffness_ratio = 0.8, .friction = 1.2, .rolling_stiffness = 0.7, .rolling_limit = 0.8});
    for (std::size_t i = 0; i < mixed.radii.size(); ++i) mixed.class_of.push_back(i % 3 == 0 ? 1 : 0);
    RveBatch batch = make_batch({mixed, packing_of(other)}, {0, 1, 0, 1});
    for (std::size_t k = 0; k < 4; ++k) fill(batch.committed, k, k % 2 == 0 ? dense : other);
    return batch;
  };
  expect_lanes_bits(make, motions(4), EngineSettings{});
}

TEST_F(TeamKernel, HasTheLanesBitsWithWideGrading) {
  // Sizes of 1 to 10 in a sheared cell, without contact until it is compressed; rows of very unlike length.
  reference::Rve rve = gas(60, 1e-4, 1e-3);
  rve.cell.xy += 0.4 * rve.cell.yy;
  for (auto& x : rve.positions) x.x += 0.4 * x.y;
  const double f = 0.7;
  const auto reports = expect_lanes_bits(
      [&] { return clones(rve, 2); },
      std::vector(2, StrainRequest{.f_rel = {f, 0.3, 0, f}, .strain_steps = 4000, .hold_cap = 100}), in_double());
  for (const RveReport& r : reports) {
    EXPECT_FALSE(is_failure(r.status)) << name_of(r.status);
    EXPECT_GT(r.contacts, 60) << "hardly a grain touches: the test shows nothing";
  }
}

TEST_F(TeamKernel, EndsWithTheLanesStatuses) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto make = [&] {
    RveBatch batch = clones(dense, 7);
    batch.committed.position(6, 3, 0) = nan;
    return batch;
  };
  const std::vector<StrainRequest> requests{{.f_rel = {nan, 0, 0, 1}, .strain_steps = 10, .hold_cap = 1},
                                            {.f_rel = {1, 0, 0, -1}, .strain_steps = 10, .hold_cap = 1},
                                            {.f_rel = {0.7, 0, 0, 0.7}, .strain_steps = 200, .hold_cap = 1},
                                            {.f_rel = {1.2, 0, 0, 1.2}, .strain_steps = 400, .hold_cap = 32},
                                            {.f_rel = {0.3, 0, 0, 0.3}, .strain_steps = 2000, .hold_cap = 16},
                                            {.f_rel = {1.0001, 0, 0, 1}, .strain_steps = 100, .hold_cap = 10},
                                            general};
  const auto reports = expect_lanes_bits(make, requests, in_double());
  const RveStatus expected[] = {RveStatus::not_finite, RveStatus::not_finite, RveStatus::overlap_limit, RveStatus::open,
                                RveStatus::overlap_limit};
  for (std::size_t k = 0; k < std::size(expected); ++k) EXPECT_EQ(reports[k].status, expected[k]) << k;
  EXPECT_FALSE(is_failure(reports[5].status));
  EXPECT_EQ(reports[6].status, RveStatus::not_finite);
}

TEST_F(TeamKernel, TooFullAListIsReportedAndKeepsTheState) {
  const reference::Rve loose = gas(150, 1e-3, 1e-3);
  RveBatch batch = clones(loose, 2);
  EngineSettings settings = in_double();
  settings.backend = Backend::teams;
  settings.skin = 2.5;
  const auto reports = run(batch, {general, general}, settings);
  EXPECT_EQ(reports[0].status, RveStatus::neighbour_overflow);
  expect_same_state(batch.trial, batch.committed, 1, loose.radii.size());
}

TEST_F(TeamKernel, HasTheLanesBitsAndTraceUnderAServo) {
  const ServoRequest squeeze{.x = {true, -1.5e5}, .y = {true, -1.2e5}, .max_rate = 1e-5, .max_steps = 300};
  const ServoRequest biaxial{
      .x = {true, -1e5}, .y = {false, -1e-6}, .max_rate = 1e-5, .max_steps = 3000, .end_strain_y = 2e-4};
  for (const Precision precision : {Precision::float32, Precision::float64}) {
    const auto reports = expect_lanes_bits([&] { return clones(dense, 2); }, std::vector{squeeze, biaxial},
                                           {.precision = precision});
    EXPECT_EQ(reports[0].status, RveStatus::step_limit);
    EXPECT_EQ(reports[1].status, RveStatus::converged);
  }
  const auto trace = [&](Backend backend) {
    RveBatch batch = clones(dense, 2);
    std::vector<ServoSample> samples;
    std::vector<ServoRequest> requests{squeeze, biaxial};
    requests[1].trace = &samples;
    requests[1].trace_interval = 20;
    std::vector<RveReport> reports(2);
    advance(batch, std::span<const ServoRequest>(requests), {.precision = Precision::float64, .backend = backend},
            reports);
    return samples;
  };
  const auto lanes = trace(Backend::lanes), teams = trace(Backend::teams);
  ASSERT_GT(lanes.size(), 5U);
  ASSERT_EQ(lanes.size(), teams.size());
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    EXPECT_EQ(teams[k].step, lanes[k].step);
    EXPECT_EQ(teams[k].strain_y, lanes[k].strain_y);
    EXPECT_EQ(teams[k].stress_yy, lanes[k].stress_yy);
    EXPECT_EQ(teams[k].unbalanced, lanes[k].unbalanced);
  }
}

TEST(TeamScratch, GrainsOfAnRveFitTheFastMemoryOfAGpu) {
  constexpr std::size_t fast = 40 * 1024;  // what Kokkos leaves of a block's 48 KiB
  EXPECT_LT(teams::team_scratch_bytes(700, Precision::float32).hot, fast);
  for (const int grains : {700, 1500}) {
    for (const Precision precision : {Precision::float32, Precision::float64}) {
      const teams::TeamScratchBytes bytes = teams::team_scratch_bytes(grains, precision);
      std::printf("%d grains: %zu bytes fast, %zu besides\n", grains, bytes.hot, bytes.cold);
      EXPECT_LT(bytes.hot + bytes.cold, 20U << 20);  // Kokkos' limit of level 1
    }
  }
}

TEST_F(TeamKernel, RefusesWhatItCannotDo) {
  RveBatch batch = clones(dense, 1);
  EngineSettings settings{.backend = Backend::teams, .tangent = TangentKind::elastic};
  expect_throws<std::invalid_argument>([&] { run(batch, {general}, settings); }, "the only tangent is eq. (4)");
  settings = {.backend = Backend::teams, .team_size = 100000};
  expect_throws<std::invalid_argument>([&] { run(batch, {general}, settings); }, "no teams of that size");
}

}  // namespace
}  // namespace voussoir::kernels
