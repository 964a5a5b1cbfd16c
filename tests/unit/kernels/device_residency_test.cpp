// RVEs whose states stay on the device: which state is committed, and what an answer may depend on. Everything is
// compared bit by bit.

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <thread>

#include "tests/device_blocks.hpp"
#include "tests/same_answers.hpp"

namespace voussoir::kernels {
namespace {

constexpr std::size_t n = 6;

class DeviceResidency : public testing::TestWithParam<Blocks> {
 protected:
  static void SetUpTestSuite() { dense = reference::consolidated_packing(40, 2, 1e5, 0.0, reference::Material{}); }
  static inline reference::Rve dense;

  [[nodiscard]] static RveBatch unlike(std::size_t rves = n) {
    RveBatch batch = clones(dense, rves);
    for (std::size_t k = 0; k < rves; ++k) batch.committed.rotation(k, 0) = 0.1 * static_cast<double>(k);
    return batch;
  }
  [[nodiscard]] std::unique_ptr<device::ResidentRves> held(const RveBatch& batch,
                                                           Precision precision = Precision::float32) const {
    return hold(batch, precision, GetParam());
  }
};

EngineSettings with_tangents() {
  EngineSettings settings;
  settings.tangent = TangentKind::elastic;
  settings.tangent_tolerance = 0.1;
  return settings;
}

void expect_same_states(const RveStates& a, const RveStates& b) {
  for (std::size_t k = 0; k < a.rotation.extent(0); ++k) expect_same_state(a, b, k, a.rotation.extent(1));
}
void expect_same_reports(const std::vector<RveReport>& a, const std::vector<RveReport>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) expect_same_report(a[k], b[k], k);
}

INSTANTIATE_TEST_SUITE_P(Blocks, DeviceResidency,
                         testing::Values(Blocks{}, Blocks{BlockKind::in_memory, 3}, Blocks{BlockKind::in_registers, 7}),
                         [](const auto& of) {
                           std::string name = name_of(of.param);
                           std::erase_if(name, [](char c) { return c == ' ' || c == ','; });
                           return name;
                         });

TEST_P(DeviceResidency, GivesTheSameBitsRunAfterRun) {
  const RveBatch batch = unlike();
  const auto first = held(batch), second = held(batch);
  expect_same_reports(advance_held(*first, motions(n), with_tangents()),
                      advance_held(*second, motions(n), with_tangents()));
  expect_same_states(states_of(*first, batch, true), states_of(*second, batch, true));
  // The trial state of the first run does not enter the second one.
  const auto reports = advance_held(*second, motions(n), with_tangents());
  expect_same_reports(advance_held(*first, motions(n), with_tangents()), reports);
  expect_same_states(states_of(*first, batch, true), states_of(*second, batch, true));
}

TEST_P(DeviceResidency, AnswersDependNeitherOnOtherRvesNorOnTheirOrder) {
  const RveBatch batch = unlike();
  const auto all = held(batch), some = held(batch);
  const auto expected = advance_held(*all, motions(n), with_tangents());
  std::vector<RveReport> reports(n);
  reports[1].steps = -7;
  for (const std::vector<int>& rves : {std::vector{4, 0}, std::vector{5, 3, 2}, std::vector<int>{}})
    advance_held(*some, motions(n), with_tangents(), reports, rves);
  EXPECT_EQ(reports[1].steps, -7) << "the report of an RVE that was not asked for has changed";
  const RveStates trial = states_of(*some, batch, true), expected_trial = states_of(*all, batch, true);
  for (const std::size_t k : {0, 2, 3, 4, 5}) {
    expect_same_report(reports[k], expected[k], k);
    expect_same_state(trial, expected_trial, k, dense.radii.size());
  }
  expect_same_state(trial, batch.committed, 1, dense.radii.size());
  // The same in a larger batch, where another has a position that is not a number.
  RveBatch larger = unlike(n + 5);
  larger.committed.position(n + 1, 7, 1) = std::numeric_limits<double>::quiet_NaN();
  const auto more = advance_held(*held(larger), motions(n + 5), with_tangents());
  EXPECT_EQ(more[n + 1].status, RveStatus::not_finite);
  for (std::size_t k = 0; k < n; ++k) expect_same_report(more[k], expected[k], k);
}

TEST_P(DeviceResidency, ACopyComesDownWhileRvesMoveOn) {
  // RVE 2 fails, so that its committed state stands in the other slot than those of its neighbours.
  const RveBatch batch = unlike();
  const auto rves = held(batch);
  std::vector<StrainRequest> requests = motions(n);
  requests[2].f_rel.xx = std::numeric_limits<double>::quiet_NaN();
  advance_held(*rves, requests, {});
  rves->commit({});
  const RveStates expected = states_of(*rves, batch, false);
  rves->copy_committed();
  RveStates brought("brought", n, static_cast<int>(dense.radii.size()), static_cast<int>(expected.history_size()));
  std::thread way([&] { EXPECT_GT(rves->bring_copy(device::plain(brought)), 0U); });
  advance_held(*rves, motions(n), {});
  rves->commit({});
  advance_held(*rves, motions(n), {});
  way.join();
  expect_same_states(brought, expected);
}

TEST_P(DeviceResidency, ACommitKeepsBackWhatItIsTold) {
  // RVEs 1 and 4 are kept back, 2 fails, 3 is not advanced.
  const RveBatch batch = unlike();
  const auto rves = held(batch);
  std::vector<StrainRequest> requests = motions(n);
  requests[2].f_rel.xx = std::numeric_limits<double>::quiet_NaN();
  std::vector<RveReport> reports(n);
  advance_held(*rves, requests, {}, reports, {0, 1, 2, 4, 5});
  const RveStates before = states_of(*rves, batch, false), trial = states_of(*rves, batch, true);
  expect_same_states(before, batch.committed);
  for (const std::size_t k : {2, 3}) expect_same_state(trial, before, k, dense.radii.size());
  for (const std::size_t k : {0, 1, 4, 5}) EXPECT_NE(trial.position(k, 0, 0), before.position(k, 0, 0)) << k;
  rves->commit(std::array{4, 1});
  const RveStates after = states_of(*rves, batch, false);
  for (const std::size_t k : {0, 5}) expect_same_state(after, trial, k, dense.radii.size());
  for (const std::size_t k : {1, 2, 3, 4}) expect_same_state(after, before, k, dense.radii.size());
  // No trial state is left, so that another commit changes nothing.
  expect_same_states(states_of(*rves, batch, true), after);
  rves->commit({});
  expect_same_states(states_of(*rves, batch, false), after);
}

TEST_P(DeviceResidency, ADownloadWritesTheRvesThatItIsTold) {
  const RveBatch batch = unlike();
  const auto rves = held(batch);
  advance_held(*rves, motions(n), {});
  RveStates to("untouched", n, static_cast<int>(dense.radii.size()), 2);
  rves->download(device::plain(to), std::array{3, 1}, true);
  const RveStates trial = states_of(*rves, batch, true);
  for (const std::size_t k : {1, 3}) expect_same_state(to, trial, k, dense.radii.size());
  for (const std::size_t k : {0, 2, 4, 5}) {
    EXPECT_EQ(to.position(k, 5, 0), 0.0);
    EXPECT_EQ(to.contact_count(k), 0);
  }
}

TEST_P(DeviceResidency, AnUploadBeginsAnew) {
  const RveBatch batch = unlike();
  const auto rves = held(batch);
  const auto expected = advance_held(*rves, motions(n), {});
  rves->commit({});
  advance_held(*rves, motions(n), {});
  rves->upload(device::plain(batch.committed));
  expect_same_states(states_of(*rves, batch, false), batch.committed);
  expect_same_states(states_of(*rves, batch, true), batch.committed);
  rves->commit({});
  expect_same_states(states_of(*rves, batch, false), batch.committed);
  expect_same_reports(advance_held(*rves, motions(n), {}), expected);
}

TEST_P(DeviceResidency, AFailureAfterASuccessLeavesNoTrialState) {
  const RveBatch batch = unlike(2);
  const auto rves = held(batch);
  std::vector<StrainRequest> requests = motions(2);
  advance_held(*rves, requests, {});
  requests[0].f_rel.xx = std::numeric_limits<double>::quiet_NaN();
  advance_held(*rves, requests, {});
  rves->commit({});
  expect_same_state(states_of(*rves, batch, false), batch.committed, 0, dense.radii.size());
}

TEST_P(DeviceResidency, CandidatesThatHoldOverCommitsGiveTheBitsOfNewOnes) {
  // Loose grains, in RVEs 0 and 2 with gaps of at least 0.08 and 0.13 diameters, are pressed together along x. A strain
  // of 3.3 % spends most of what candidates allow, one of 6 % that follows brings pairs into contact that were outside
  // the skin before both: RVE 0 takes them by turns. RVE 2 takes the small one until pairs touch that were no
  // candidates. A large strain renews lists on its way: that of RVE 1 is kept back, that of RVE 3 is committed.
  const auto spaced = [](double gap) {
    const double radius = 1e-3 * (1 + gap);
    reference::Rve rve = reference::loose_packing(300, radius, radius, 4, reference::Material{});
    rve.radii.assign(rve.radii.size(), 1e-3);
    rve.rotations.assign(rve.radii.size(), 0.0);
    return rve;
  };
  RveBatch batch = clones(spaced(0), 4);
  fill(batch.committed, 0, spaced(0.08));
  fill(batch.committed, 2, spaced(0.13));
  const auto resident = held(batch), anew = held(batch);
  const auto pressed = [](double to) {
    return StrainRequest{.f_rel = {to, 0, 0, 1}, .strain_steps = 60, .hold_cap = 4};
  };
  const StrainRequest small = pressed(0.967), next = pressed(0.94);
  const StrainRequest large{.f_rel = {0.85, 0, 0, 1.12}, .strain_steps = 60, .hold_cap = 4};
  int contacts = 0;
  for (int increment = 0; increment < 8; ++increment) {
    SCOPED_TRACE(testing::Message() << "increment " << increment);
    const std::vector requests{increment % 2 == 0 ? small : next, increment % 3 == 1 ? large : small, small,
                               increment % 4 == 1 ? large : small};
    anew->upload(device::plain(states_of(*resident, batch, false)));
    const auto reports = advance_held(*resident, requests, {});
    expect_same_reports(reports, advance_held(*anew, requests, {}));
    expect_same_states(states_of(*resident, batch, true), states_of(*anew, batch, true));
    contacts = std::max(contacts, std::max(reports[1].contacts, reports[3].contacts));
    resident->commit(increment % 3 == 1 ? std::vector{1} : std::vector<int>{});
  }
  EXPECT_GT(contacts, 10) << "hardly a grain touches: the test shows nothing";
}

TEST_P(DeviceResidency, CandidatesHoldNoLongerThanTheGrainsOwnMotionsAllow) {
  // Ten grains touch in a row along x, and between the row's ends there is a gap of a fifth of a diameter across the
  // cell's border. The row hardly yields, so that a small strain closes the gap by the cell's whole shortening: nearly
  // all of it is the grains' own motion, and what the strain itself moves neighbours by is a tenth.
  const double d = 2e-3, length = 10.2 * d;
  reference::Rve row = reference::loose_packing(10, d / 2, d / 2, 4, reference::Material{});
  for (std::size_t i = 0; i < 10; ++i) row.positions[i] = {0.9999 * d * static_cast<double>(i), length / 2};
  row.radii.assign(10, d / 2);
  row.rotations.assign(10, 0.0);
  row.cell = {length, 0, 0, length};
  const RveBatch batch = clones(row, 1);
  const auto resident = held(batch), anew = held(batch);
  const StrainRequest pressed{.f_rel = {1 - 0.03 / 10.2, 0, 0, 1}, .strain_steps = 200, .hold_cap = 50};
  for (int increment = 0; increment < 9; ++increment) {
    SCOPED_TRACE(testing::Message() << "increment " << increment);
    anew->upload(device::plain(states_of(*resident, batch, false)));
    const auto reports = advance_held(*resident, std::vector{pressed}, {});
    expect_same_reports(reports, advance_held(*anew, std::vector{pressed}, {}));
    if (increment == 8) {
      EXPECT_EQ(reports[0].contacts, 10) << "the row's ends did not meet: the test shows nothing";
    }
    resident->commit({});
  }
}

TEST_P(DeviceResidency, OtherSkinsFindOtherCandidates) {
  const RveBatch batch = unlike(2);
  const auto rves = held(batch);
  EngineSettings narrow, wide;
  narrow.skin = 0.01;
  wide.skin = 0.2;
  for (const EngineSettings& settings : {narrow, wide, narrow})
    expect_same_reports(advance_held(*rves, motions(2), settings), advance_held(*held(batch), motions(2), settings));
}

TEST_P(DeviceResidency, FloatAndDoubleAndServosShareOneState) {
  // A servo between two strains goes on from the committed state.
  const RveBatch batch = unlike(2);
  const ServoRequest squeeze{.x = {true, -1.5e5}, .y = {true, -1.2e5}, .max_rate = 1e-5, .max_steps = 100};
  for (const Precision precision : {Precision::float32, Precision::float64}) {
    const EngineSettings settings{.precision = precision};
    const auto rves = held(batch, precision), anew = held(batch, precision);
    advance_held(*rves, motions(2), settings);
    rves->commit({});
    anew->upload(device::plain(states_of(*rves, batch, false)));
    expect_same_reports(advance_held(*rves, std::vector(2, squeeze), settings),
                        advance_held(*anew, std::vector(2, squeeze), settings));
    rves->commit({});
    anew->upload(device::plain(states_of(*rves, batch, false)));
    expect_same_reports(advance_held(*rves, motions(2), settings), advance_held(*anew, motions(2), settings));
  }
}

}  // namespace
}  // namespace voussoir::kernels
