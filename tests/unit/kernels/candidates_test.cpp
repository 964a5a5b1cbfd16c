/// Candidates that outlive commits (CandidateCache): with them and without them an RVE has the same bits.

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/engine_support.hpp"

namespace voussoir::kernels {
namespace {

class Candidates : public testing::TestWithParam<Precision> {
 protected:
  static void SetUpTestSuite() { sand = reference::consolidated_packing(60, 2, 1e5, 0.0, reference::Material{}); }
  static inline reference::Rve sand;

  /// One increment of a path that shears and turns; the RVEs move apart from one another.
  void advance_and_commit(RveBatch& batch, int increment, double size) const {
    std::vector<StrainRequest> requests(batch.size());
    for (std::size_t k = 0; k < batch.size(); ++k) {
      const double e = size * (1 + 0.3 * std::cos(static_cast<double>(k) + increment));
      requests[k] = {.f_rel = {1 - 0.3 * e, e, -0.5 * e, 1 - e}, .strain_steps = 100, .hold_cap = 200};
    }
    static_cast<void>(run(batch, requests, EngineSettings{.precision = GetParam()}));
    commit(batch);
  }

  static void expect_same_states(const RveBatch& a, const RveBatch& b) {
    for (std::size_t k = 0; k < a.size(); ++k) {
      ASSERT_EQ(a.committed.contact_count(k), b.committed.contact_count(k)) << k;
      for (int c = 0; c < a.committed.contact_count(k); ++c) {
        ASSERT_EQ(a.committed.contact_key(k, c), b.committed.contact_key(k, c)) << k;
        ASSERT_EQ(a.committed.contact_history(k, c, 0), b.committed.contact_history(k, c, 0)) << k;
      }
      for (std::size_t i = 0; i < sand.radii.size(); ++i) {
        ASSERT_EQ(a.committed.position(k, i, 0), b.committed.position(k, i, 0)) << k << " " << i;
        ASSERT_EQ(a.committed.rotation(k, i), b.committed.rotation(k, i)) << k << " " << i;
      }
    }
  }
};

TEST_P(Candidates, OutliveCommitsWithTheSameBits) {
  RveBatch kept = clones(sand, 5), anew = clones(sand, 5);
  int outlived = 0, renewed = 0;
  for (int increment = 0; increment < 30; ++increment) {
    forget_candidates(anew);
    advance_and_commit(kept, increment, 1e-3);
    advance_and_commit(anew, increment, 1e-3);
    ASSERT_NO_FATAL_FAILURE(expect_same_states(kept, anew)) << "increment " << increment;
    for (std::size_t k = 0; k < kept.size(); ++k) {
      const bool holds = kept.candidates.skin[k] > 0 && kept.candidates.spent[k] < 1.0 / 3 * kept.candidates.skin[k];
      ++(holds ? outlived : renewed);
    }
  }
  EXPECT_GT(outlived, 30) << "candidates are found anew in most increments: the test tests nothing";
  EXPECT_GT(renewed, 5) << "candidates are never used up: the test tests nothing";
}

/// A motion that renews lists on its way leaves no candidates that could be too old.
TEST_P(Candidates, EndWithARebase) {
  RveBatch batch = clones(sand, 2);
  advance_and_commit(batch, 0, 0.1);
  EXPECT_LT(*std::max_element(batch.candidates.skin.begin(), batch.candidates.skin.end()), 0);
}

INSTANTIATE_TEST_SUITE_P(Precisions, Candidates, testing::Values(Precision::float32, Precision::float64));

}  // namespace
}  // namespace voussoir::kernels
