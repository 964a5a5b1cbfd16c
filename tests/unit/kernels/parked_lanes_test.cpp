/// The lanes that a group puts aside (kernels/lanes/park.hpp): they keep their bits, and the others do not wait for
/// them.

#include <gtest/gtest.h>

#include "kernels/isa/choose_lanes.hpp"
#include "kernels/isa/lane_set.hpp"
#include "tests/engine_support.hpp"

namespace voussoir::kernels {
namespace {

constexpr int long_hold = 3000;
constexpr int short_hold = 160;

/// Motions after which every eighth RVE rests for `long_hold` steps, but for one of these, which rests longer and so
/// goes on alone.
std::vector<StrainRequest> motions(std::size_t n) {
  std::vector<StrainRequest> requests(n);
  for (std::size_t k = 0; k < n; ++k) {
    const double e = 1e-3 * std::cos(1.0 * static_cast<double>(k));
    const int hold = k == 8 ? 2 * long_hold : k % 8 == 0 ? long_hold : short_hold + static_cast<int>(k);
    requests[k] = {.f_rel = {1 + e, 3 * e, -e, 1 - 2 * e}, .strain_steps = 100, .hold_cap = hold};
  }
  return requests;
}

class ParkedLanes : public testing::TestWithParam<Precision> {
 protected:
  static void SetUpTestSuite() { sand = reference::consolidated_packing(40, 2, 1e5, 0.0, reference::Material{}); }
  static inline reference::Rve sand;

  [[nodiscard]] EngineSettings settings() const {
    EngineSettings s{.precision = GetParam(), .tangent = TangentKind::elastic};
    s.hold_tolerance = 0;  // every RVE comes to its step limit
    s.skin = 0.01;         // lists are renewed on the way
    return s;
  }
};

TEST_P(ParkedLanes, KeepTheirBits) {
  const std::size_t n = 100;
  const auto requests = motions(n);
  RveBatch batch = clones(sand, n);
  const auto reports = run(batch, requests, settings());
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}, std::size_t{8}, std::size_t{64}, std::size_t{99}}) {
    SCOPED_TRACE(k);
    RveBatch alone = clones(sand, 1);
    const RveReport expected = run(alone, {requests[k]}, settings()).front();
    EXPECT_EQ(reports[k].steps, expected.steps);
    EXPECT_EQ(reports[k].status, RveStatus::step_limit);
    EXPECT_EQ(reports[k].unbalanced, expected.unbalanced);
    EXPECT_TRUE(std::equal(reports[k].stress, reports[k].stress + 4, expected.stress));
    EXPECT_TRUE(std::equal(reports[k].tangent, reports[k].tangent + 6, expected.tangent));
    ASSERT_EQ(batch.trial.contact_count(k), alone.trial.contact_count(0));
    for (std::size_t i = 0; i < sand.radii.size(); ++i) {
      ASSERT_EQ(batch.trial.position(k, i, 0), alone.trial.position(0, i, 0)) << i;
      ASSERT_EQ(batch.trial.rotation(k, i), alone.trial.rotation(0, i)) << i;
    }
    for (int c = 0; c < alone.trial.contact_count(0); ++c) {
      ASSERT_EQ(batch.trial.contact_key(k, c), alone.trial.contact_key(0, c)) << c;
      ASSERT_EQ(batch.trial.contact_history(k, c, 0), alone.trial.contact_history(0, c, 0)) << c;
    }
  }
}

/// Groups that are formed before the holds are known hold long and short ones alike: without the lanes that are put
/// aside, nearly all groups would take `long_hold` steps.
TEST_P(ParkedLanes, LetTheOthersEnd) {
  const LaneSet& lanes = *chosen_lanes().lanes;
  const auto width = static_cast<std::size_t>(GetParam() == Precision::float32 ? lanes.floats : lanes.doubles);
  if (width < 4) GTEST_SKIP() << "a group of " << width << " lanes has none to put aside";
  const std::size_t n = 8 * width;
  RveBatch batch = clones(sand, n);
  const auto requests = motions(n);
  std::vector<RveReport> reports(n);
  const Work work = advance(batch, std::span<const StrainRequest>(requests), settings(), reports);
  EXPECT_LT(work.lane_steps, n * long_hold * sand.radii.size() * 3 / 4);
}

INSTANTIATE_TEST_SUITE_P(Precisions, ParkedLanes, testing::Values(Precision::float32, Precision::float64));

}  // namespace
}  // namespace voussoir::kernels
