// The engine against the plain oracle, and the same bits wherever an RVE runs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/engine_support.hpp"

namespace voussoir::kernels {
namespace {

class Engine : public testing::Test {
 protected:
  static void SetUpTestSuite() { dense = reference::consolidated_packing(40, 2, 1e5, 0.0, reference::Material{}); }
  static inline reference::Rve dense;
};

/// Runs both on the same motion for the same steps and compares everything that the engine answers.
void compare(const reference::Rve& start, const StrainRequest& request, const EngineSettings& settings,
             std::size_t n_clones, double tolerance) {
  RveBatch batch = clones(start, n_clones);
  const RveReport report = run(batch, std::vector(n_clones, request), settings).back();
  ASSERT_FALSE(is_failure(report.status)) << name_of(report.status);
  reference::Rve expected = start;
  const reference::StrainReport oracle = strain(
      expected, plain(request.f_rel),
      {.steps = request.strain_steps, .hold_steps = report.steps - request.strain_steps});
  const reference::Mat2 sigma = love_weber(expected, contacts(expected));
  const double p = reference::pressure(reference::stress(expected));
  const double stress[4] = {sigma.xx, sigma.xy, sigma.yx, sigma.yy};
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(report.stress[k], stress[k], 0.1 * tolerance * p) << k;
  const reference::VoigtMatrix d = tangent(expected);
  const double upper[6] = {d[0][0], d[0][1], d[0][2], d[1][1], d[1][2], d[2][2]};
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(report.tangent[k], upper[k], 1e-3 * tolerance * d[0][0]) << k;
  EXPECT_EQ(report.contacts, static_cast<int>(contacts(expected).size()));
  EXPECT_NEAR(report.unbalanced, oracle.unbalanced_ratio, 100 * tolerance * oracle.unbalanced_ratio);
  const std::size_t last = n_clones - 1;
  EXPECT_NEAR(batch.trial.cell(last, 1), expected.cell.xy, 1e-16);
  const reference::Mat2 inverse = reference::inverse(expected.cell);
  for (std::size_t i = 0; i < start.radii.size(); ++i) {
    const reference::Vec2 x{batch.trial.position(last, i, 0), batch.trial.position(last, i, 1)};
    const reference::Vec2 f = inverse * (x - expected.positions[i]);
    const reference::Vec2 off = expected.cell * reference::Vec2{f.x - std::round(f.x), f.y - std::round(f.y)};
    EXPECT_LT(norm(off), tolerance * 2e-5) << i;  // of ten overlaps: all grains may drift together
    EXPECT_NEAR(batch.trial.rotation(last, i), expected.rotations[i], tolerance * 1e-3);
  }
  ASSERT_EQ(batch.trial.contact_count(last), static_cast<int>(expected.histories.size()));
  std::size_t c = 0;
  for (const auto& [pair, history] : expected.histories) {
    EXPECT_EQ(batch.trial.contact_key(last, c), pair_key(pair.first, pair.second));
    EXPECT_NEAR(batch.trial.contact_history(last, c, 0), history.tangential, tolerance * 20);
    EXPECT_NEAR(batch.trial.contact_history(last, c, 1), history.moment, tolerance * 20 * 2e-3);
    ++c;
  }
}

const StrainRequest general{.f_rel = {1.0004, 0.0012, -0.0005, 0.9994}, .strain_steps = 300, .hold_cap = 60};

// Rounding differs, and grows with the path: 1e-15 becomes some 4e-10 of a contact's force in these few hundred steps.
constexpr double rounding = 5e-9;

TEST_F(Engine, FollowsTheOracle) { compare(dense, general, in_double(), 2, rounding); }
TEST_F(Engine, FollowsTheOracleAlone) { compare(dense, general, in_double(), 1, rounding); }

TEST_F(Engine, FollowsTheOracleThroughManyRebases) {
  EngineSettings settings = in_double();
  settings.skin = 0.0005;
  settings.list_interval = 1;
  compare(dense, general, settings, 2, rounding);
}

TEST_F(Engine, FollowsTheOracleThroughARotation) {
  const double c = std::cos(0.1), s = std::sin(0.1);
  compare(dense, {.f_rel = Mat2{c, -s, s, c} * Mat2{1, 0.001, 0, 0.999}, .strain_steps = 450, .hold_cap = 20},
          in_double(), 2, rounding);
}

TEST_F(Engine, FollowsTheOracleWithoutRolling) {
  reference::Rve rve = dense;
  rve.material.rolling_stiffness = 0;
  for (auto& [pair, history] : rve.histories) history.moment = 0;
  compare(rve, general, in_double(), 2, rounding);
}

TEST_F(Engine, FloatFollowsTheOracle) {
  compare(dense, {.f_rel = {1.0001, 0.0002, 0, 0.9999}, .strain_steps = 200, .hold_cap = 20}, EngineSettings{}, 2,
          2e-3);
}

bool same_bits(const RveReport& a, const RveReport& b) {
  return a.status == b.status && a.steps == b.steps && a.contacts == b.contacts &&
         std::equal(a.stress, a.stress + 4, b.stress) && std::equal(a.tangent, a.tangent + 6, b.tangent) &&
         a.unbalanced == b.unbalanced;
}

TEST_F(Engine, SameBitsAloneInAnyGroupAndBesideANaN) {
  for (const Precision precision : {Precision::float32, Precision::float64}) {
    const EngineSettings settings{.precision = precision};
    RveBatch alone = clones(dense, 1);
    const RveReport expected = run(alone, {general}, settings).front();
    EXPECT_TRUE(same_bits(run(alone, {general}, settings).front(), expected)) << "again";
    const std::size_t n = 19;
    for (const std::size_t place : {std::size_t{0}, std::size_t{7}, std::size_t{18}}) {
      RveBatch batch = clones(dense, n);
      std::vector<StrainRequest> requests(n);
      for (std::size_t k = 0; k < n; ++k) {
        const double e = 1e-3 * std::cos(1.0 * static_cast<double>(k));
        requests[k] = {
            .f_rel = {1 + e, 3 * e, -e, 1 - 2 * e}, .strain_steps = 200 + 10 * static_cast<int>(k), .hold_cap = 64};
      }
      requests[place] = general;
      const std::size_t broken = (place + 1) % n;
      batch.committed.position(broken, 3, 0) = std::numeric_limits<double>::quiet_NaN();
      const auto reports = run(batch, requests, settings);
      EXPECT_TRUE(same_bits(reports[place], expected))
          << "place " << place << " precision " << static_cast<int>(precision);
      EXPECT_EQ(reports[broken].status, RveStatus::not_finite);
      for (std::size_t i = 0; i < dense.radii.size(); ++i) {
        ASSERT_EQ(batch.trial.position(place, i, 0), alone.trial.position(0, i, 0)) << i;
        ASSERT_EQ(batch.trial.rotation(place, i), alone.trial.rotation(0, i)) << i;
      }
    }
  }
}

/// Beside others a pair without friction has its law's forces of zero; alone it leaves them out. The histories of
/// before, which the law forgets at once, are gone in both.
TEST_F(Engine, SameBitsAloneAndInAGroupWithoutFriction) {
  reference::Rve rve = dense;
  rve.material.friction = 0;
  const ServoAxis axis{.stress_controlled = true, .target = -1.05e5};  // stresses are summed in every step
  const ServoRequest squeeze{.x = axis, .y = axis, .max_rate = 2e-5, .max_steps = 300};
  for (const bool rolls : {true, false}) {
    if (!rolls) rve.material.rolling_stiffness = rve.material.rolling_limit = 0;
    for (const Precision precision : {Precision::float32, Precision::float64}) {
      SCOPED_TRACE(static_cast<int>(precision));
      const EngineSettings settings{.precision = precision};
      RveBatch alone = clones(rve, 1), group = clones(rve, 5);
      const std::vector<ServoRequest> one{squeeze}, five(5, squeeze);
      std::vector<RveReport> expected(1), reports(5);
      advance(alone, std::span<const ServoRequest>(one), settings, expected);
      advance(group, std::span<const ServoRequest>(five), settings, reports);
      EXPECT_TRUE(same_bits(reports[2], expected[0]));
      for (std::size_t i = 0; i < rve.radii.size(); ++i) {
        ASSERT_EQ(group.trial.position(2, i, 0), alone.trial.position(0, i, 0)) << i;
        ASSERT_EQ(group.trial.rotation(2, i), alone.trial.rotation(0, i)) << i;
      }
      ASSERT_EQ(group.trial.contact_count(2), alone.trial.contact_count(0));
      for (int c = 0; c < alone.trial.contact_count(0); ++c) {
        const auto k = static_cast<std::size_t>(c);
        ASSERT_EQ(group.trial.contact_history(2, k, 0), alone.trial.contact_history(0, k, 0)) << c;
      }
    }
  }
}

TEST_F(Engine, RigidRotationRotatesStressAndNothingElse) {
  RveBatch batch = clones(dense, 2);
  const auto reports = run(batch,
                           {{.f_rel = {0, -1, 1, 0}, .strain_steps = 400, .hold_cap = 16},
                            {.f_rel = identity2, .strain_steps = 400, .hold_cap = 16}},
                           in_double());
  const double p = reports[1].pressure();
  EXPECT_EQ(reports[0].contacts, reports[1].contacts);
  EXPECT_NEAR(reports[0].stress[0], reports[1].stress[3], 1e-11 * p);
  EXPECT_NEAR(reports[0].stress[3], reports[1].stress[0], 1e-11 * p);
  EXPECT_NEAR(reports[0].stress[1], -reports[1].stress[2], 1e-11 * p);
}

TEST_F(Engine, NoContactIsOpenAndNoFailure) {
  RveBatch batch = clones(dense, 2);
  const auto reports = run(
      batch, std::vector(2, StrainRequest{.f_rel = {1.2, 0, 0, 1.2}, .strain_steps = 400, .hold_cap = 32}),
      in_double());
  EXPECT_EQ(reports[0].status, RveStatus::open);
  EXPECT_EQ(reports[0].stress[0], 0.0);
  EXPECT_EQ(reports[0].contacts, 0);
}

TEST_F(Engine, ImpossibleMotionsAreReported) {
  RveBatch batch = clones(dense, 4);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto reports = run(batch,
                           {{.f_rel = {nan, 0, 0, 1}, .strain_steps = 10, .hold_cap = 1},
                            {.f_rel = {1, 0, 0, -1}, .strain_steps = 10, .hold_cap = 1},
                            {.f_rel = {0.7, 0, 0, 0.7}, .strain_steps = 200, .hold_cap = 1},
                            {.f_rel = {1.0001, 0, 0, 1}, .strain_steps = 100, .hold_cap = 10}},
                           in_double());
  EXPECT_EQ(reports[0].status, RveStatus::not_finite);
  EXPECT_EQ(reports[1].status, RveStatus::not_finite);
  EXPECT_EQ(reports[2].status, RveStatus::overlap_limit);
  EXPECT_FALSE(is_failure(reports[3].status));
}

}  // namespace
}  // namespace voussoir::kernels
