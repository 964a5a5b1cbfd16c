// The blocks of a device, on the host, against the lanes, which are tested against the oracle: within rounding of their
// answers, however many threads a block has and wherever it keeps its pairs.

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "kernels/course/rve_report.hpp"
#include "tests/device_blocks.hpp"
#include "tests/near_answers.hpp"
#include "tests/same_answers.hpp"
#include "tests/throws.hpp"
#include "tests/tiled_packing.hpp"

namespace voussoir::kernels {
namespace {

class DeviceBlocks : public testing::Test {
 protected:
  static void SetUpTestSuite() { dense = reference::consolidated_packing(40, 2, 1e5, 0.0, reference::Material{}); }
  static inline reference::Rve dense;
};

const std::vector<Blocks> usual{{}, {BlockKind::in_memory, 3}, {BlockKind::in_registers, 7}};

// The contract is 1e-8 over 200 steps. On the same processor only sums over all pairs are taken in another order, and
// 3e-15 is measured; what is left of 1e-8 is for a device's own rounding.
constexpr Tolerance exactly{.stress = 3e-14, .position = 1e-13};
// Measured 8e-5; float and double lanes differ by 3e-5 of the pressure in these few hundred steps.
constexpr Tolerance roughly{.stress = 5e-4, .position = 1e-4, .counts = false};

reference::Rve gas(int grains, double smallest, double largest) {
  reference::Rve rve = reference::loose_packing(grains, smallest, largest, 4, reference::Material{});
  rve.rotations.assign(rve.radii.size(), 0.0);
  return rve;
}

/// Largest force of the contacts that a state remembers, which is at least that of 100 Pa.
double force_scale(const RveStates& states, const Packing& packing, std::size_t rve) {
  double most = 100.0 * packing.mean_diameter() * packing.thickness;
  for (int c = 0; c < states.contact_count(rve); ++c)
    most = std::max(most, std::abs(states.contact_history(rve, c, 0)));
  return most;
}

/// Advances copies of a batch by lanes and by blocks, and compares all they answer.
/// @param make () -> RveBatch, the same at each call
template <class Make, class Request>
std::vector<RveReport> expect_lanes_answers(const Make& make, const std::vector<Request>& requests,
                                            const EngineSettings& settings, const Tolerance& tolerance,
                                            const std::vector<Blocks>& kinds = usual) {
  RveBatch lanes = make();
  const std::vector<RveReport> expected = run_lanes(lanes, requests, settings);
  for (const Blocks& blocks : kinds) {
    SCOPED_TRACE(name_of(blocks));
    const RveBatch batch = make();
    const auto held = hold(batch, settings.precision, blocks);
    const std::vector<RveReport> reports = advance_held(*held, requests, settings);
    const RveStates trial = states_of(*held, batch, true);
    for (std::size_t k = 0; k < batch.size(); ++k) {
      expect_near_report(reports[k], expected[k], tolerance, k);
      if (is_failure(expected[k].status)) {
        expect_same_state(trial, batch.committed, k, batch.packing(k).radii.size());
      } else {
        expect_near_state(trial, lanes.trial, batch.packing(k), tolerance,
                          force_scale(lanes.trial, batch.packing(k), k), k);
      }
    }
  }
  return expected;
}

const StrainRequest general{.f_rel = {1.0004, 0.0012, -0.0005, 0.9994}, .strain_steps = 300, .hold_cap = 60};
const StrainRequest two_hundred_steps{.f_rel = {1.0004, 0.0012, -0.0005, 0.9994}, .strain_steps = 180, .hold_cap = 20};

TEST_F(DeviceBlocks, AgreesWithTheLanesInDouble) {
  std::vector<Blocks> kinds{{}};
  for (const int threads : {1, 2, 7, 16, 32}) kinds.push_back({BlockKind::in_memory, threads});
  for (const int threads : {7, 16, 32}) kinds.push_back({BlockKind::in_registers, threads});
  const auto reports = expect_lanes_answers([&] { return clones(dense, 2); }, std::vector(2, two_hundred_steps),
                                            in_double(), exactly, kinds);
  for (const RveReport& r : reports) EXPECT_GT(r.contacts, 60);
}

TEST_F(DeviceBlocks, AgreesWithTheLanesWithMoreThreadsThanGrains) {
  const StrainRequest short_one{.f_rel = {1.0001, 0.0003, -0.0001, 0.9998}, .strain_steps = 16, .hold_cap = 4};
  expect_lanes_answers([&] { return clones(dense, 1); }, std::vector{short_one}, in_double(), exactly,
                       {{BlockKind::in_memory, 128}, {BlockKind::in_registers, 128}});
}

TEST_F(DeviceBlocks, AgreesWithTheLanesInFloatAsFarAsTheyAgreeWithDouble) {
  RveBatch in_two = clones(dense, 6), in_one = clones(dense, 6);
  const auto exact = run_lanes(in_two, motions(6), in_double());
  const auto lanes = run_lanes(in_one, motions(6), {});
  double allowed = 0;
  for (std::size_t k = 0; k < 6; ++k) allowed = std::max(allowed, stress_difference(lanes[k], exact[k]));
  EXPECT_LT(allowed, roughly.stress);
  for (const Blocks& blocks : usual) {
    SCOPED_TRACE(name_of(blocks));
    const RveBatch batch = clones(dense, 6);
    const auto reports = advance_held(*hold(batch, Precision::float32, blocks), motions(6), EngineSettings{});
    for (std::size_t k = 0; k < 6; ++k) {
      EXPECT_EQ(reports[k].status, exact[k].status);
      EXPECT_LT(stress_difference(reports[k], exact[k]), 3 * allowed) << k;
    }
  }
}

TEST_F(DeviceBlocks, AgreesWithTheLanesThroughManyRebases) {
  EngineSettings settings = in_double();
  settings.skin = 0.0005;
  settings.list_interval = 1;
  expect_lanes_answers([&] { return clones(dense, 3); }, motions(3), settings, exactly);
  settings.precision = Precision::float32;
  expect_lanes_answers([&] { return clones(dense, 3); }, motions(3), settings, roughly);
}

TEST_F(DeviceBlocks, AgreesWithTheLanesInTheNextIncrementsToo) {
  for (const auto& [settings, tolerance] : {std::pair{EngineSettings{}, roughly}, std::pair{in_double(), exactly}}) {
    RveBatch lanes = clones(dense, 3);
    const RveBatch batch = clones(dense, 3);
    std::vector<RveReport> expected;
    for (int k = 0; k < 3; ++k) {
      expected = run_lanes(lanes, std::vector(3, two_hundred_steps), settings);
      commit(lanes);
    }
    for (const Blocks& blocks : usual) {
      SCOPED_TRACE(name_of(blocks));
      const auto held = hold(batch, settings.precision, blocks);
      std::vector<RveReport> reports;
      for (int k = 0; k < 3; ++k) {
        reports = advance_held(*held, std::vector(3, two_hundred_steps), settings);
        held->commit({});
      }
      const RveStates committed = states_of(*held, batch, false);
      for (std::size_t k = 0; k < 3; ++k) {
        expect_near_report(reports[k], expected[k], tolerance, k);
        expect_near_state(committed, lanes.committed, batch.packing(k), tolerance,
                          force_scale(lanes.committed, batch.packing(k), k), k);
      }
    }
  }
}

TEST_F(DeviceBlocks, AgreesWithTheLanesWithoutRolling) {
  reference::Rve rve = dense;
  rve.material.rolling_stiffness = 0;
  for (auto& [pair, history] : rve.histories) history.moment = 0;
  expect_lanes_answers([&] { return clones(rve, 2); }, motions(2), in_double(), exactly);
  expect_lanes_answers([&] { return clones(rve, 2); }, motions(2), EngineSettings{}, roughly);
}

TEST_F(DeviceBlocks, AgreesWithTheLanesWithClassesAndUnlikePackings) {
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
  expect_lanes_answers(make, motions(4), in_double(), exactly);
  expect_lanes_answers(make, motions(4), EngineSettings{}, roughly);
}

TEST_F(DeviceBlocks, AgreesWithTheLanesWithWideGrading) {
  // Sizes of 1 to 10 in a sheared cell, without contact until it is compressed; rows of very unlike length.
  reference::Rve rve = gas(60, 1e-4, 1e-3);
  rve.cell.xy += 0.4 * rve.cell.yy;
  for (auto& x : rve.positions) x.x += 0.4 * x.y;
  const double f = 0.7;
  const auto reports = expect_lanes_answers(
      [&] { return clones(rve, 2); },
      std::vector(2, StrainRequest{.f_rel = {f, 0.3, 0, f}, .strain_steps = 4000, .hold_cap = 100}), in_double(),
      exactly, {{}, {BlockKind::in_memory, 2}});
  for (const RveReport& r : reports) {
    EXPECT_FALSE(is_failure(r.status)) << name_of(r.status);
    EXPECT_GT(r.contacts, 60) << "hardly a grain touches: the test shows nothing";
  }
}

TEST_F(DeviceBlocks, EndsWithTheLanesStatuses) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto make = [&] {
    RveBatch batch = clones(dense, 9);
    batch.committed.position(6, 3, 0) = nan;
    batch.committed.cell(8, 0) = -batch.committed.cell(8, 0);
    return batch;
  };
  const std::vector<StrainRequest> requests{{.f_rel = {nan, 0, 0, 1}, .strain_steps = 10, .hold_cap = 1},
                                            {.f_rel = {1, 0, 0, -1}, .strain_steps = 10, .hold_cap = 1},
                                            {.f_rel = {0.7, 0, 0, 0.7}, .strain_steps = 200, .hold_cap = 1},
                                            {.f_rel = {1.2, 0, 0, 1.2}, .strain_steps = 400, .hold_cap = 32},
                                            {.f_rel = {0.3, 0, 0, 0.3}, .strain_steps = 2000, .hold_cap = 16},
                                            {.f_rel = {1.001, 0.003, 0, 0.998}, .strain_steps = 20, .hold_cap = 1},
                                            general,
                                            {.f_rel = {1.0001, 0, 0, 1}, .strain_steps = 100, .hold_cap = 2000},
                                            general};
  for (const auto& [settings, tolerance] :
       {std::pair{with_low_limit({}), roughly}, std::pair{with_low_limit(in_double()), exactly}}) {
    const auto reports = expect_lanes_answers(make, requests, settings, tolerance);
    const RveStatus expected[] = {RveStatus::not_finite, RveStatus::not_finite,    RveStatus::overlap_limit,
                                  RveStatus::open,       RveStatus::overlap_limit, RveStatus::step_limit,
                                  RveStatus::not_finite, RveStatus::converged,     RveStatus::not_finite};
    for (std::size_t k = 0; k < std::size(expected); ++k)
      EXPECT_EQ(reports[k].status, expected[k]) << k << " " << name_of(reports[k].status);
  }
}

TEST_F(DeviceBlocks, TooNarrowACellIsReportedAsByTheLanes) {
  EngineSettings settings = in_double();
  settings.skin = 2.5;
  expect_lanes_answers([&] { return clones(dense, 2); }, std::vector(2, general), settings, exactly);
}

TEST_F(DeviceBlocks, ACrushedPackingIsGivenUpAsByTheLanes) {
  // No single contact passes the limit, but all of them overlap by a quarter on average.
  const auto reports = expect_lanes_answers(
      [&] { return clones(dense, 2); },
      std::vector(2, StrainRequest{.f_rel = {0.7, 0, 0, 0.7}, .strain_steps = 400, .hold_cap = 1}), in_double(),
      exactly);
  EXPECT_EQ(reports[0].status, RveStatus::overlap_limit) << name_of(reports[0].status);
  EXPECT_LT(reports[0].largest_overlap, EngineSettings{}.overlap_limit);
  EXPECT_GT(reports[0].mean_overlap, mean_overlap_limit);
}

TEST_F(DeviceBlocks, AListWithoutRoomRunsAgainWithMoreOfIt) {
  // There is room for fewer pairs than are near, then for fewer than touch, then for fewer than a wide skin lists.
  const reference::Rve loose = gas(400, 1e-3, 1e-3);
  const int touching = static_cast<int>(dense.histories.size());
  struct Try {
    const reference::Rve& rve;
    double skin;
    int first_pairs;
  };
  for (const Try& t : {Try{dense, 0.08, 64}, Try{dense, 0.0005, touching - 1}, Try{loose, 4, 0}}) {
    EngineSettings settings = in_double();
    settings.skin = t.skin;
    settings.list_interval = t.skin < 0.01 ? 1 : 8;
    const std::vector<StrainRequest> requests(2, two_hundred_steps);
    const Blocks blocks{BlockKind::in_memory, 2, t.first_pairs};
    SCOPED_TRACE(testing::Message() << "a skin of " << t.skin);
    const auto lanes = expect_lanes_answers([&] { return clones(t.rve, 2); }, requests, settings, exactly,
                                            {{}, blocks});
    for (const RveReport& r : lanes) EXPECT_FALSE(is_failure(r.status)) << name_of(r.status);
    const RveBatch batch = clones(t.rve, 2);
    std::vector<RveReport> reports(2);
    const auto work = advance_held(*hold(batch, Precision::float64, blocks), requests, settings, reports,
                                   first_rves(2));
    EXPECT_GE(work.enlarged, 2U);
  }
}

TEST_F(DeviceBlocks, AgreesWithTheLanesUnderAServo) {
  const ServoRequest squeeze{.x = {true, -1.5e5}, .y = {true, -1.2e5}, .max_rate = 1e-5, .max_steps = 300};
  const ServoRequest biaxial{
      .x = {true, -1e5}, .y = {false, -1e-6}, .max_rate = 1e-5, .max_steps = 3000, .end_strain_y = 2e-4};
  const std::vector requests{squeeze, biaxial};
  // The control feeds the rounding of its sums back: 2e-12 is measured in the rate.
  constexpr Tolerance followed{.stress = 2e-11, .position = 1e-11};
  for (const auto& [settings, tolerance] : {std::pair{EngineSettings{}, roughly}, std::pair{in_double(), followed}}) {
    const auto reports = expect_lanes_answers([&] { return clones(dense, 2); }, requests, settings, tolerance);
    EXPECT_EQ(reports[0].status, RveStatus::step_limit);
    EXPECT_EQ(reports[1].status, RveStatus::converged);
  }
}

TEST_F(DeviceBlocks, KeepsTheLanesTraceUnderAServo) {
  // The block without room, whose RVE runs again after it has taken samples, keeps none of them.
  std::vector<ServoSample> samples;
  const std::vector<ServoRequest> requests{{.x = {true, -1e5}, .y = {false, -1e-6}, .max_rate = 1e-5, .max_steps = 90},
                                           {.x = {true, -5e5},
                                            .y = {true, -5e5},
                                            .max_rate = 1e-5,
                                            .max_steps = 600,
                                            .trace = &samples,
                                            .trace_interval = 20}};
  EngineSettings settings = in_double();
  settings.skin = 0.002;
  settings.list_interval = 1;
  RveBatch batch = clones(dense, 2);
  run_lanes(batch, requests, settings);
  const std::vector<ServoSample> lanes = samples;
  const int one_too_few = batch.trial.contact_count(1) - 1;
  ASSERT_GT(one_too_few, static_cast<int>(dense.histories.size())) << "the list is too full from the start";
  ASSERT_EQ(lanes.size(), 30U);
  for (const Blocks& blocks :
       {Blocks{}, Blocks{BlockKind::in_memory, 2, one_too_few}, Blocks{BlockKind::in_registers, 7}}) {
    SCOPED_TRACE(name_of(blocks));
    samples.clear();
    const auto held = hold(batch, Precision::float64, blocks);
    std::vector<RveReport> reports(2);
    const auto work = advance_held(*held, requests, settings, reports, first_rves(2));
    if (blocks.first_pairs > 0) {
      EXPECT_GT(work.enlarged, 0U) << "every list has room: the test shows nothing";
    }
    ASSERT_EQ(samples.size(), lanes.size());
    for (std::size_t k = 0; k < lanes.size(); ++k) {
      EXPECT_EQ(samples[k].step, lanes[k].step);
      EXPECT_NEAR(samples[k].strain_x, lanes[k].strain_x, 1e-12);
      EXPECT_NEAR(samples[k].strain_y, lanes[k].strain_y, 1e-12);
      EXPECT_NEAR(samples[k].stress_xx, lanes[k].stress_xx, 1e-8 * 1e5);
      EXPECT_NEAR(samples[k].stress_yy, lanes[k].stress_yy, 1e-8 * 1e5);
      EXPECT_NEAR(samples[k].stress_xy, lanes[k].stress_xy, 1e-8 * 1e5);
      EXPECT_NEAR(samples[k].unbalanced, lanes[k].unbalanced, 1e-7);
    }
  }
}

TEST_F(DeviceBlocks, FindsTheLanesStaticTangentsWithinTheirTolerance) {
  for (const TangentKind kind : {TangentKind::elastic, TangentKind::static_}) {
    for (const double tolerance : {0.03, 1e-3}) {
      EngineSettings settings = in_double();
      settings.tangent = kind;
      settings.tangent_tolerance = tolerance;
      RveBatch lanes = clones(dense, 3);
      const auto expected = run_lanes(lanes, motions(3), settings);
      for (const Blocks& blocks : usual) {
        SCOPED_TRACE(name_of(blocks));
        const RveBatch batch = clones(dense, 3);
        const auto reports = advance_held(*hold(batch, Precision::float64, blocks), motions(3), settings);
        for (std::size_t k = 0; k < 3; ++k) {
          expect_near_report(reports[k], expected[k], exactly, k);
          EXPECT_EQ(reports[k].tangent_kind, kind);
          EXPECT_FALSE(reports[k].tangent_capped);
          EXPECT_GT(reports[k].tangent_iterations, 0);
          EXPECT_LE(tangent_difference(reports[k], expected[k]), tolerance * tolerance) << k;
        }
      }
    }
  }
}

TEST_F(DeviceBlocks, AStaticTangentLeavesOutTheSpringsThatTheLanesLeaveOut) {
  // In the middle of a shear contacts slide, so that the two kinds differ.
  const std::vector<StrainRequest> shear(1, {.f_rel = {1.002, 0.008, 0, 0.998}, .strain_steps = 400, .hold_cap = 1});
  std::vector<RveReport> found;
  for (const TangentKind kind : {TangentKind::elastic, TangentKind::static_}) {
    EngineSettings settings = in_double();
    settings.tangent = kind;
    settings.tangent_tolerance = 1e-3;
    RveBatch lanes = clones(dense, 1);
    const RveReport expected = run_lanes(lanes, shear, settings).front();
    const RveBatch batch = clones(dense, 1);
    found.push_back(advance_held(*hold(batch, Precision::float64, {}), shear, settings).front());
    EXPECT_LE(tangent_difference(found.back(), expected), 1e-6);
  }
  EXPECT_GT(tangent_difference(found[0], found[1]), 0.01) << "no contact slides: the test shows nothing";
}

TEST_F(DeviceBlocks, SaysWhereATangentsIterationsReachTheirLimit) {
  EngineSettings settings = in_double();
  settings.tangent = TangentKind::elastic;
  settings.tangent_tolerance = 1e-4;
  settings.tangent_iterations = 3;
  const RveBatch batch = clones(dense, 1);
  const auto report = advance_held(*hold(batch, Precision::float64, {}), std::vector{general}, settings).front();
  EXPECT_TRUE(report.tangent_capped);
  EXPECT_EQ(report.tangent_iterations, 3);
}

TEST_F(DeviceBlocks, AgreesWithTheLanesOnLargePackings) {
  const reference::Rve tile = reference::consolidated_packing(50, 3, 1e5, 0.0, reference::Material{});
  const StrainRequest short_one{.f_rel = {1.0002, 0.0006, -0.0002, 0.9997}, .strain_steps = 40, .hold_cap = 8};
  EngineSettings settings = in_double();
  settings.skin = 0.01;
  struct Size {
    int columns, rows, threads;
  };
  for (const Size& s : {Size{2, 3, 7}, Size{2, 7, 16}, Size{5, 6, 32}}) {
    SCOPED_TRACE(testing::Message() << 50 * s.columns * s.rows << " grains");
    const reference::Rve rve = reference::tiled(tile, s.columns, s.rows);
    const auto reports = expect_lanes_answers([&] { return clones(rve, 1); }, std::vector{short_one}, settings, exactly,
                                              {{}, {BlockKind::in_registers, s.threads}});
    EXPECT_GT(reports[0].contacts, 75 * s.columns * s.rows);
  }
}

TEST_F(DeviceBlocks, RefusesWhatItCannotDo) {
  const RveBatch batch = clones(dense, 1);
  const auto held = hold(batch, Precision::float32, {});
  EngineSettings settings{.tangent = TangentKind::loading};
  expect_throws<std::invalid_argument>([&] { advance_held(*held, std::vector{general}, settings); },
                                       "no loading tangents");
  ServoRequest recorded;
  recorded.microstructure.fabric = true;
  expect_throws<std::invalid_argument>([&] { advance_held(*held, std::vector{recorded}, EngineSettings{}); },
                                       "no microstructure");
}

}  // namespace
}  // namespace voussoir::kernels
