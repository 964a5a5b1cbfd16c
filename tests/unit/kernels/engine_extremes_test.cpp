// The engine at its limits: any lattice of the same packing, huge motions, opening and closing, unlimited shear.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/contact/cell.hpp"
#include "tests/engine_support.hpp"

namespace voussoir::kernels {
namespace {

class EngineExtremes : public testing::Test {
 protected:
  static void SetUpTestSuite() { dense = reference::consolidated_packing(60, 3, 1e5, 0.0, reference::Material{}); }
  static inline reference::Rve dense;
};

constexpr StrainRequest still{.f_rel = identity2, .strain_steps = 0, .hold_cap = 1};

TEST_F(EngineExtremes, CellVectorsOfTheSameLatticeGiveTheSameStress) {
  RveBatch plain_cell = clones(dense, 1);
  const RveReport expected = run(plain_cell, {still}, in_double()).front();
  for (const int k : {1, 2, 3, 5, 10, -7}) {
    reference::Rve sheared = dense;
    sheared.cell.xy += k * sheared.cell.xx;
    sheared.cell.yy += k * sheared.cell.yx;
    RveBatch batch = clones(sheared, 1);
    const RveReport report = run(batch, {still}, in_double()).front();
    EXPECT_EQ(report.contacts, expected.contacts) << k;
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(report.stress[c], expected.stress[c], 1e-10 * expected.pressure()) << k;
  }
}

TEST(ReducedLattice, HasTheSameAreaAndShortVectors) {
  const Mat2 reduced = reduced_lattice({2.0, 9.3, 0.0, 1.5});
  EXPECT_NEAR(reduced.det(), 3.0, 1e-14);
  EXPECT_NEAR(reduced.xy, -0.7, 1e-14);  // 9.3 - 5 * 2
  const double aa = reduced.xx * reduced.xx + reduced.yx * reduced.yx,
               bb = reduced.xy * reduced.xy + reduced.yy * reduced.yy;
  EXPECT_LE(std::abs(reduced.xx * reduced.xy + reduced.yx * reduced.yy), 0.5 * std::min(aa, bb) + 1e-12);  // Gauss
}

TEST_F(EngineExtremes, ShearIsUnlimitedAndTheFlipOfTheCellShowsInNothing) {
  RveBatch batch = clones(dense, 1);
  // Room to dilate first: at constant volume a dense packing's pressure would crush it.
  run(batch, {{.f_rel = {1.03, 0, 0, 1.03}, .strain_steps = 400, .hold_cap = 400}}, in_double());
  commit(batch);
  const StrainRequest shear{.f_rel = {1, 0.02, 0, 1}, .strain_steps = 400, .hold_cap = 400};
  double largest_jump = 0;
  for (int increment = 0; increment < 100; ++increment) {  // to 200 %
    const RveReport report = run(batch, {shear}, in_double()).front();
    ASSERT_FALSE(is_failure(report.status)) << increment << " " << name_of(report.status);
    commit(batch);
    const RveReport again = run(batch, {still}, in_double()).front();  // restored from the cell that was stored
    for (int c = 0; c < 4; ++c) largest_jump = std::max(largest_jump, std::abs(again.stress[c] - report.stress[c]));
    ASSERT_NEAR(again.contacts, report.contacts, 1) << increment;  // restoring takes a step: a grain may just touch
  }
  EXPECT_LT(largest_jump, 100.0);  // [Pa] of some 1e5: one step under what the hold left unbalanced
  const RveStates& end = batch.committed;
  EXPECT_LE(std::hypot(end.cell(0, 1), end.cell(0, 3)), 1.5 * std::hypot(end.cell(0, 0), end.cell(0, 2)));
}

TEST_F(EngineExtremes, ExplodingAndCrushingMotionsEndWithAStatus) {
  RveBatch batch = clones(dense, 5);
  const auto reports = run(batch,
                           {{.f_rel = {1e4, 0, 0, 1e4}, .strain_steps = 1, .hold_cap = 16},
                            {.f_rel = {0.3, 0, 0, 0.3}, .strain_steps = 20000, .hold_cap = 16},
                            {.f_rel = {1, 50, 0, 1}, .strain_steps = 1, .hold_cap = 16},
                            {.f_rel = {1, 0, 0, 1}, .strain_steps = 0, .hold_cap = 0},
                            {.f_rel = {1.0001, 0, 0, 1}, .strain_steps = 100, .hold_cap = 10}},
                           with_low_limit(in_double()));
  EXPECT_EQ(reports[0].status, RveStatus::open);
  EXPECT_EQ(reports[1].status, RveStatus::overlap_limit);
  EXPECT_EQ(reports[2].status, RveStatus::overlap_limit);
  EXPECT_LT(reports[1].steps, 20000) << "given up on the way, not at the end";
  EXPECT_GT(reports[1].largest_overlap, 0.3);
  for (const std::size_t k : {std::size_t{3}, std::size_t{4}}) EXPECT_FALSE(is_failure(reports[k].status)) << k;
  commit(batch);  // failed RVEs keep the state they had
  RveBatch fresh = clones(dense, 1);
  for (std::size_t i = 0; i < dense.radii.size(); ++i) {
    EXPECT_EQ(batch.committed.position(1, i, 0), fresh.committed.position(0, i, 0));
  }
}

TEST_F(EngineExtremes, OpenedContactsCloseAgain) {
  RveBatch batch = clones(dense, 1);
  RveReport report = run(batch, {{.f_rel = {1.02, 0, 0, 1.02}, .strain_steps = 400, .hold_cap = 16}}, in_double())
                         .front();
  EXPECT_EQ(report.status, RveStatus::open);
  commit(batch);
  report = run(batch, {{.f_rel = {1 / 1.025, 0, 0, 1 / 1.025}, .strain_steps = 2000, .hold_cap = 4000}}, in_double())
               .front();
  EXPECT_FALSE(is_failure(report.status));
  EXPECT_GT(report.pressure(), 1e5);
}

TEST_F(EngineExtremes, ResultsDoNotDependOnWhenListsAreMade) {
  const StrainRequest fast{.f_rel = {1.1, 0, 0, 0.9}, .strain_steps = 10, .hold_cap = 200};
  RveBatch often = clones(dense, 1), seldom = clones(dense, 1);
  EngineSettings settings = in_double();
  settings.hold_tolerance = 0;
  const RveReport coarse = run(seldom, {fast}, settings).front();
  settings.list_interval = 1;
  // The same number of steps, which follows from the list interval in a motion as fast as this.
  const RveReport
      fine = run(often, {{.f_rel = fast.f_rel, .strain_steps = coarse.steps - 200, .hold_cap = 200}}, settings).front();
  EXPECT_EQ(fine.steps, coarse.steps);
  EXPECT_EQ(fine.contacts, coarse.contacts);
  for (int c = 0; c < 4; ++c) EXPECT_NEAR(fine.stress[c], coarse.stress[c], 1e-5 * std::abs(coarse.stress[0]));
}

TEST_F(EngineExtremes, ACellTooNarrowForItsGrainsIsRefused) {
  reference::Rve rve = dense;
  rve.radii[0] = 0.26 * rve.cell.xx;
  RveBatch batch = clones(rve, 1);
  EXPECT_EQ(run(batch, {still}, in_double()).front().status, RveStatus::neighbour_overflow);
}

TEST_F(EngineExtremes, OneOfFourThousandIsGivenNaNAndNoOtherBitChanges) {
  constexpr std::size_t n = 4096, broken = 1234;
  RveBatch healthy = clones(dense, n), with_nan = clones(dense, n);
  std::vector<StrainRequest> requests(n);
  for (std::size_t k = 0; k < n; ++k) {
    const double e = 1e-4 * std::cos(1.0 * static_cast<double>(k));
    requests[k] = {
        .f_rel = {1 + e, 3 * e, -e, 1 - 2 * e}, .strain_steps = 20 + static_cast<int>(k % 7), .hold_cap = 16};
  }
  const auto expected = run(healthy, requests, EngineSettings{});
  with_nan.committed.position(broken, 3, 0) = std::numeric_limits<double>::quiet_NaN();
  const auto reports = run(with_nan, requests, EngineSettings{});
  EXPECT_EQ(reports[broken].status, RveStatus::not_finite);
  for (std::size_t k = 0; k < n; ++k) {
    if (k == broken) continue;
    ASSERT_TRUE(std::equal(expected[k].stress, expected[k].stress + 4, reports[k].stress)) << k;
    ASSERT_EQ(expected[k].steps, reports[k].steps) << k;
    ASSERT_EQ(healthy.trial.position(k, 7, 1), with_nan.trial.position(k, 7, 1)) << k;
  }
  commit(with_nan);
  const auto again = run(with_nan, requests, EngineSettings{});
  EXPECT_EQ(again[broken].status, RveStatus::not_finite) << "it keeps the state it had";
}

}  // namespace
}  // namespace voussoir::kernels
