// RVEs that answer by their tangent: closed forms of the extrapolation, what is deferred and when, nothing lost.
#include "host/material/deferral.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "host/material/answers.hpp"
#include "host/material/rve_pool.hpp"
#include "tests/host_support.hpp"
#include "tests/throws.hpp"

namespace voussoir::host {
namespace {

using Gradients = std::vector<fem::Gradient>;

fem::Gradient gradient(double xx, double xy, double yx, double yy) {
  fem::Gradient h;
  h << xx, xy, yx, yy;
  return h;
}

fem::Gradient compose(const fem::Gradient& second, const fem::Gradient& first) {
  return second + first + second * first;
}

/// Isotropic stiffness (lambda, mu), stress (-100, -200, 30) kPa.
kernels::RveReport grains_at_rest() {
  constexpr double lambda = 1e8, mu = 0.5e8;
  kernels::RveReport report;
  report.steps = 10;
  const double stress[] = {-1e5, 0.3e5, 0.3e5, -2e5};
  const double tangent[] = {lambda + 2 * mu, lambda, 0, lambda + 2 * mu, 0, mu};
  std::copy(std::begin(stress), std::end(stress), report.stress);
  std::copy(std::begin(tangent), std::end(tangent), report.tangent);
  return report;
}

TEST(Deferral, AStrainAddsTheTangentsStress) {
  const Extrapolation by_tangent = extrapolate(grains_at_rest(), gradient(std::expm1(1e-4), 0, 0, std::expm1(-3e-4)));
  EXPECT_NEAR(by_tangent.stress[0], -1e5 + 2e8 * 1e-4 - 1e8 * 3e-4, 1e-4);
  EXPECT_NEAR(by_tangent.stress[1], -2e5 + 1e8 * 1e-4 - 2e8 * 3e-4, 1e-4);
  EXPECT_NEAR(by_tangent.stress[2], 0.3e5, 1e-4);
  EXPECT_NEAR(by_tangent.change, std::max(std::hypot(1e4, 5e4), 2e8 * std::hypot(1e-4, 3e-4)), 1e-3);
}

/// A quarter turn exchanges the axes; nothing changes in those that turn along.
TEST(Deferral, ARotationTurnsStressAndTangentRigidly) {
  kernels::RveReport grains = grains_at_rest();
  grains.tangent[0] = 4e8;
  const Extrapolation quarter = extrapolate(grains, gradient(-1, -1, 1, -1));
  EXPECT_NEAR(quarter.stress[0], -2e5, 1e-6);
  EXPECT_NEAR(quarter.stress[1], -1e5, 1e-6);
  EXPECT_NEAR(quarter.stress[2], -0.3e5, 1e-6);
  EXPECT_NEAR(quarter.tangent(0, 0), 2e8, 1e-3);
  EXPECT_NEAR(quarter.tangent(1, 1), 4e8, 1e-3);
  EXPECT_NEAR(quarter.tangent(2, 2), 0.5e8, 1e-3);
  EXPECT_NEAR(quarter.change, 0, 1e-4);
}

/// Strain before rotation is strain in the axes of the grains; after it, in turned ones.
TEST(Deferral, StrainAndRotationKeepTheirOrder) {
  const fem::Gradient turn = gradient(-1, -1, 1, -1), pull = gradient(std::expm1(1e-4), 0, 0, 0);
  const Extrapolation pulled_first = extrapolate(grains_at_rest(), compose(turn, pull));
  EXPECT_NEAR(pulled_first.stress[0], -2e5 + 1e8 * 1e-4, 1e-4);
  EXPECT_NEAR(pulled_first.stress[1], -1e5 + 2e8 * 1e-4, 1e-4);
  const Extrapolation turned_first = extrapolate(grains_at_rest(), compose(pull, turn));
  EXPECT_NEAR(turned_first.stress[0], -2e5 + 2e8 * 1e-4, 1e-4);
  EXPECT_NEAR(turned_first.stress[1], -1e5 + 1e8 * 1e-4, 1e-4);
}

TEST(Deferral, OnlyGrainsAtRestUnderPressureAreDeferred) {
  const auto answers = [](const kernels::RveReport& grains, double bound, double strain) {
    Deferral deferral(bound, 2e4);
    deferral.start(std::span(&grains, 1));
    kernels::RveReport report;
    return deferral.answer(0, gradient(strain, 0, 0, 0), report);
  };
  kernels::RveReport grains = grains_at_rest();  // p = 150 kPa; the change is hypot(2e8, 1e8) times the strain
  EXPECT_TRUE(answers(grains, 1e-3, 0.66e-6));
  EXPECT_FALSE(answers(grains, 1e-3, 0.68e-6));
  EXPECT_FALSE(answers(grains, 1e-3, std::nan("")));
  grains.status = kernels::RveStatus::open;
  EXPECT_FALSE(answers(grains, 1e-3, 0));
  grains.status = kernels::RveStatus::step_limit;
  EXPECT_FALSE(answers(grains, 1e-3, 0));
  grains.status = kernels::RveStatus::converged;
  grains.stress[0] = 1.7e5;  // p = 15 kPa, below the floor
  EXPECT_FALSE(answers(grains, 1e-3, 0));
}

/// The error is the deviation from the tangent, in proportion of the deferred part: trust falls, then doubles again.
TEST(Deferral, ErrorsAreMeasuredAndCostTrust) {
  const kernels::RveReport grains = grains_at_rest();
  Deferral deferral(1e-3, 0);
  deferral.start(std::span(&grains, 1));
  kernels::RveReport report;
  const fem::Gradient small = gradient(std::expm1(0.5e-6), 0, 0, 0), rest = gradient(std::expm1(1.5e-6), 0, 0, 0);
  ASSERT_TRUE(deferral.answer(0, small, report));
  EXPECT_EQ(report.steps, 0);
  EXPECT_TRUE(deferral.commit(0, small, report));
  deferral.begin_increment();
  ASSERT_FALSE(deferral.answer(0, rest, report));
  ASSERT_FALSE(deferral.answer(0, fem::Gradient::Zero(), report)) << "once it runs it runs to the increment's end";
  report = grains;  // the grains did not feel the strain of 2e-6 at all: 400 and 200 Pa are missing
  deferral.check(0, rest, report);
  const double missing = std::hypot(400, 200);
  EXPECT_NEAR(deferral.error(), 0.25 * missing / 1.5e5, 1e-9);
  EXPECT_FALSE(deferral.commit(0, rest, report));
  EXPECT_EQ(deferral.committed(0).trust, 1.0) << "within the bound";
  EXPECT_EQ(deferral.committed(0).gradient, fem::Gradient::Zero());

  deferral.begin_increment();
  ASSERT_TRUE(deferral.answer(0, small, report));
  deferral.commit(0, small, report);
  deferral.begin_increment();
  ASSERT_FALSE(deferral.answer(0, rest, report));
  report = grains;
  report.stress[0] += 2400;  // 2000 Pa beyond the tangent, a quarter of which is laid to the deferral: 3.3e-3 of p
  deferral.check(0, rest, report);
  const double error = 0.25 * std::hypot(2000, 200) / 1.5e5;
  EXPECT_NEAR(deferral.error(), error, 1e-7);
  deferral.commit(0, rest, report);
  EXPECT_NEAR(deferral.committed(0).trust, 0.5e-3 / error, 1e-4);
}

/// What never comes to its bound runs nevertheless, and the whole difference is then the error: the tangent might have
/// answered.
TEST(Deferral, EndsInACheckAtTheLatestAfterSomeCommits) {
  const kernels::RveReport grains = grains_at_rest();
  Deferral deferral(1e-3, 0);
  deferral.start(std::span(&grains, 1));
  kernels::RveReport report;
  const fem::Gradient tiny = gradient(1e-9, 0, 0, 0);
  for (int k = 0; k < Deferral::most_commits; ++k) {
    deferral.begin_increment();
    ASSERT_TRUE(deferral.answer(0, tiny, report)) << k;
    ASSERT_TRUE(deferral.commit(0, tiny, report));
  }
  deferral.begin_increment();
  ASSERT_FALSE(deferral.answer(0, tiny, report));
  report = grains;
  report.stress[3] += 1e4;  // they have collapsed meanwhile
  deferral.check(0, tiny, report);
  EXPECT_NEAR(deferral.error(), 1e4 / 1.5e5, 1e-4);
  EXPECT_FALSE(deferral.commit(0, tiny, report));
  deferral.begin_increment();
  EXPECT_TRUE(deferral.answer(0, tiny, report)) << "its count begins anew";
}

class DeferringPool : public testing::Test {
 protected:
  static void SetUpTestSuite() { rve = small_packing(); }

  static EngineCase engine(double defer) {
    EngineCase engine;
    engine.defer = defer;
    return engine;
  }

  fem::BatchReport step(RvePool& pool, const Gradients& h) {
    pool.begin_increment();
    const fem::BatchReport report = pool.evaluate(h, stress_, tangent_);
    EXPECT_TRUE(report.usable) << report.message;
    pool.commit();
    return report;
  }

  static inline PackedRve rve;
  std::vector<fem::Stress> stress_ = std::vector<fem::Stress>(2);
  std::vector<fem::Tangent> tangent_ = std::vector<fem::Tangent>(2);
};

const fem::Gradient tiny = gradient(1e-7, 2e-3, -2e-3, -2e-7);  // it mostly turns
const fem::Gradient large = gradient(1e-3, 0, 1e-3, -2e-3);

TEST_F(DeferringPool, GivesTheGrainsAllThatWasDeferred) {
  RvePool deferring(rve, {engine(1e-2)}, 2), plain(rve, {engine(0)}, 2);
  const fem::BatchReport first = step(deferring, {tiny, large});
  EXPECT_EQ(first.deferred, 1u);
  EXPECT_EQ(step(deferring, {tiny, large}).deferred, 1u);
  const fem::BatchReport last = step(deferring, {large, large});
  EXPECT_EQ(last.deferred, 0u);
  EXPECT_GT(last.deferral_error, 0) << "of the first RVE, which was deferred";
  EXPECT_LT(last.deferral_error, 1e-2);
  const auto answer = stress_;
  std::size_t work = 0;
  std::size_t lane_steps = 0;
  for (const auto& h : {large, large, large}) {
    const fem::BatchReport report = step(plain, {h, h});
    work = report.work;
    lane_steps = report.lane_steps;
  }
  EXPECT_GT(lane_steps, work) << "two RVEs do not fill a group of lanes";
  EXPECT_EQ(answer[1], stress_[1]) << "an RVE beside a deferred one";
  RvePool at_once(rve, {engine(0)}, 2);
  step(at_once, Gradients(2, compose(large, compose(tiny, tiny))));
  EXPECT_EQ(answer[0], stress_[0]);
  EXPECT_GT(work, first.work);
}

TEST_F(DeferringPool, KeepsToItsBound) {
  constexpr double bound = 1e-2;
  RvePool deferring(rve, {engine(bound)}, 2), plain(rve, {engine(0)}, 2);
  std::size_t deferred = 0;
  double error = 0;
  for (int k = 0; k < 20; ++k) {
    const fem::Gradient h = gradient(0, 0, 0, k < 10 ? -3e-6 : 6e-6);
    const fem::BatchReport report = step(deferring, Gradients(2, h));
    deferred += report.deferred;
    error = std::max(error, report.deferral_error);
    const auto answer = stress_;
    step(plain, Gradients(2, h));
    const double p = -0.5 * (stress_[0][0] + stress_[0][1]);
    EXPECT_LT((answer[0] - stress_[0]).norm(), bound * p) << k;
  }
  EXPECT_GT(deferred, 10u);
  EXPECT_LT(deferred, 40u);
  EXPECT_GT(error, 0);
  EXPECT_LT(error, bound);
}

TEST_F(DeferringPool, AVanishingBoundHasTheBitsOfNone) {
  RvePool on(rve, {engine(1e-300)}, 2), off(rve, {engine(0)}, 2);
  for (const auto& h : {tiny, large}) {
    EXPECT_EQ(step(on, {h, h}).deferred, 0u);
    const auto answer = stress_;
    step(off, {h, h});
    EXPECT_EQ(answer, stress_);
  }
  EXPECT_LT(off.state().size(), on.state().size()) << "nothing is stored where nothing is deferred";
}

TEST_F(DeferringPool, ACheckpointKeepsWhatIsDeferred) {
  RvePool straight(rve, {engine(1e-2)}, 2), resumed(rve, {engine(1e-2)}, 2), plain(rve, {engine(0)}, 2);
  step(straight, {tiny, large});
  resumed.set_state(straight.state());
  EXPECT_EQ(resumed.state(), straight.state());
  for (const auto& h : {tiny, large}) {
    step(straight, {h, h});
    const auto answer = stress_;
    step(resumed, {h, h});
    EXPECT_EQ(answer, stress_);
    EXPECT_EQ(resumed.state(), straight.state());
  }
  expect_throws<std::runtime_error>([&] { plain.set_state(straight.state()); }, "of another packing");
}

/// An RVE that has lost trust is not deferred after a resumption either. With a bound far below the scatter of grains
/// at rest each check fails.
TEST_F(DeferringPool, ACheckpointKeepsTheTrust) {
  constexpr double bound = 1e-10;
  const Gradients small(2, gradient(0, 0, 0, -2e-4 * bound));
  RvePool straight(rve, {engine(bound)}, 2), resumed(rve, {engine(bound)}, 2);
  int deferred = 0;
  fem::BatchReport last = step(straight, small);
  for (; last.deferred == 2 && deferred < 100; ++deferred) last = step(straight, small);
  ASSERT_GT(deferred, 0) << "nothing was deferred: the test shows nothing";
  ASSERT_GT(last.deferral_error, 4 * bound) << "no trust was lost: the test shows nothing";
  resumed.set_state(straight.state());
  EXPECT_EQ(step(straight, small).deferred, step(resumed, small).deferred);
  EXPECT_EQ(resumed.state(), straight.state());
}

/// An RVE that runs at one iterate and is deferred at none after; a failed increment leaves no trace.
TEST_F(DeferringPool, StartsAnewFromTheCommittedState) {
  RvePool pool(rve, {engine(1e-2)}, 2), other(rve, {engine(1e-2)}, 2);
  step(pool, {tiny, tiny});
  step(other, {tiny, tiny});
  pool.begin_increment();
  (void)pool.evaluate(Gradients(2, large), stress_, tangent_);
  EXPECT_EQ(pool.evaluate(Gradients(2, tiny), stress_, tangent_).deferred, 0u);
  step(pool, {tiny, tiny});
  step(other, {tiny, tiny});
  EXPECT_EQ(pool.state(), other.state());
}

}  // namespace
}  // namespace voussoir::host
