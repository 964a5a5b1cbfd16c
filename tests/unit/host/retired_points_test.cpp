// Points that have been dug out: they answer zero, cost nothing and count in no report, and no other point notices.
#include "fem/retired_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <vector>

#include "fem/linear_elastic.hpp"
#include "host/material/mirrored_batch.hpp"
#include "host/material/rve_pool.hpp"
#include "tests/host_support.hpp"

namespace voussoir::host {
namespace {

constexpr std::size_t points = 8;
constexpr std::array<std::size_t, 3> dug{1, 4, 5};

bool is_dug(std::size_t p) { return std::find(dug.begin(), dug.end(), p) != dug.end(); }

std::vector<fem::Gradient> gradients_of(double scale) {
  std::vector<fem::Gradient> out(points, fem::Gradient::Zero());
  for (std::size_t p = 0; p < points; ++p) {
    out[p](1, 1) = -scale * static_cast<double>(p + 1);
    out[p](0, 1) = 0.3 * scale;
  }
  return out;
}

struct Answers {
  std::vector<fem::Stress> stress = std::vector<fem::Stress>(points);
  std::vector<fem::Tangent> tangent = std::vector<fem::Tangent>(points);
  fem::BatchReport report;
};

/// An increment that is committed, and its answers.
Answers increment(fem::MaterialBatch& batch, double scale) {
  Answers out;
  batch.begin_increment();
  out.report = batch.evaluate(gradients_of(scale), out.stress, out.tangent);
  EXPECT_TRUE(out.report.usable) << out.report.message;
  batch.commit();
  return out;
}

void expect_zero_where_dug(const Answers& got, const Answers& whole) {
  for (std::size_t p = 0; p < points; ++p) {
    EXPECT_EQ(got.stress[p], is_dug(p) ? fem::Stress::Zero() : whole.stress[p]) << p;
    EXPECT_EQ(got.tangent[p], is_dug(p) ? fem::Tangent::Zero() : whole.tangent[p]) << p;
  }
}

std::unique_ptr<RvePool> pool_of(double defer) {
  PoolOptions options;
  options.engine.defer = defer;
  return std::make_unique<RvePool>(small_packing(), options, points);
}

/// The pool goes on beside one that stays whole, with and without deferral.
class RetiredPool : public testing::TestWithParam<double> {};

TEST_P(RetiredPool, OtherPointsAnswerWithTheSameBitsAtLessCost) {
  const auto whole = pool_of(GetParam()), rest = pool_of(GetParam());
  increment(*whole, 1e-5);
  increment(*rest, 1e-5);
  rest->retire(dug);
  for (const double scale : {2e-5, 1e-5, 4e-5}) {
    const Answers all = increment(*whole, scale), some = increment(*rest, scale);
    expect_zero_where_dug(some, all);
    if (all.report.deferred == 0) {
      const double share = static_cast<double>(some.report.work) / static_cast<double>(all.report.work);
      EXPECT_LT(share, 0.75);  // three of eight points are gone
    }
    EXPECT_NE(some.report.slowest, 4U);
  }
  std::vector<fem::Stress> stress(points);
  rest->committed(stress, {});
  for (const std::size_t p : dug) EXPECT_EQ(stress[p], fem::Stress::Zero());
  for (const fem::PointField& field : rest->fields()) {
    for (std::size_t p = 0; p < points; ++p) EXPECT_EQ(std::isnan(field.values[p]), is_dug(p)) << field.name << p;
  }
}

TEST_P(RetiredPool, AStateThatGoesThroughBytesGoesOnWithTheSameBits) {
  const auto before = pool_of(GetParam()), after = pool_of(GetParam());
  increment(*before, 1e-5);
  before->retire(dug);
  increment(*before, 2e-5);
  after->set_state(before->state());
  after->retire(dug);
  EXPECT_EQ(after->state(), before->state());
  const Answers one = increment(*before, 1e-5), other = increment(*after, 1e-5);
  EXPECT_EQ(one.stress, other.stress);
  EXPECT_EQ(one.report.stress_noise, other.report.stress_noise);
  EXPECT_EQ(after->state(), before->state());
}

TEST_P(RetiredPool, AHeldStateBringsNoDugOutPointBack) {
  const auto pool = pool_of(GetParam());
  increment(*pool, 1e-5);
  const auto held = pool->hold();
  pool->retire(dug);
  const Answers once = increment(*pool, 2e-5);
  pool->return_to(*held);
  EXPECT_EQ(increment(*pool, 2e-5).stress, once.stress);
}

INSTANTIATE_TEST_SUITE_P(WithAndWithoutDeferral, RetiredPool, testing::Values(0.0, 1e-2));

TEST(RetiredPoints, ReportsCountTheOthersOnly) {
  const auto pool = pool_of(0.0);
  std::array<std::size_t, points> all{};
  std::iota(all.begin(), all.end(), std::size_t{0});
  pool->begin_increment();
  std::vector<fem::Gradient> torn = gradients_of(1e-5);
  for (const std::size_t p : dug) torn[p] = 0.05 * fem::Gradient::Identity();  // these grains lose all contacts
  Answers answers;
  EXPECT_EQ(pool->evaluate(torn, answers.stress, answers.tangent).open, dug.size());
  pool->retire(dug);
  pool->begin_increment();
  const fem::BatchReport rest = pool->evaluate(torn, answers.stress, answers.tangent);
  EXPECT_TRUE(rest.usable) << rest.message;
  EXPECT_EQ(rest.open, 0U);
  pool->retire(all);
  const fem::BatchReport none = pool->evaluate(torn, answers.stress, answers.tangent);
  EXPECT_EQ(none.work, 0U);
  EXPECT_EQ(none.stress_noise, 0.0);
  const std::size_t beyond = points;
  EXPECT_THROW(pool->retire({&beyond, 1}), std::out_of_range);
}

TEST(RetiredPoints, ElasticPointsAndMirroredOnesAnswerZeroToo) {
  fem::LinearElastic whole(points, {.initial_stress = {-1e3, -1e3, 0}}),
      rest(points, {.initial_stress = {-1e3, -1e3, 0}});
  rest.retire(dug);
  expect_zero_where_dug(increment(rest, 1e-4), increment(whole, 1e-4));
  MirroredBatch mirrored(pool_of(0.0)), mirrored_rest(pool_of(0.0));
  mirrored_rest.retire(dug);
  expect_zero_where_dug(increment(mirrored_rest, 1e-5), increment(mirrored, 1e-5));
}

}  // namespace
}  // namespace voussoir::host
