// The mirror image of a material: exact, its own inverse, nothing for a material that is its own mirror image.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "fem/linear_elastic.hpp"
#include "host/mirrored_batch.hpp"

namespace voussoir::host {
namespace {

constexpr std::size_t n = 4;

std::unique_ptr<fem::LinearElastic> elastic(const fem::Stress& initial) {
  return std::make_unique<fem::LinearElastic>(
      n, fem::ElasticOptions{.initial_stress = initial, .strain = fem::ElasticStrain::logarithmic});
}

struct Answer {
  std::vector<fem::Stress> stress = std::vector<fem::Stress>(n);
  std::vector<fem::Tangent> tangent = std::vector<fem::Tangent>(n);
};

Answer evaluate(fem::MaterialBatch& batch) {
  fem::Gradient h;
  h << 0.01, 0.03, -0.02, 0.005;
  Answer answer;
  EXPECT_TRUE(batch.evaluate(std::vector<fem::Gradient>(n, h), answer.stress, answer.tangent).usable);
  return answer;
}

TEST(MirroredBatch, LeavesAnIsotropicMaterialAsItIs) {
  const auto plain = elastic(fem::Stress(-1e3, -1e3, 0));
  MirroredBatch mirrored(elastic(fem::Stress(-1e3, -1e3, 0)));
  const Answer expected = evaluate(*plain);
  const Answer answer = evaluate(mirrored);
  for (std::size_t p = 0; p < n; ++p) {
    EXPECT_EQ(answer.stress[p], expected.stress[p]) << p;
    EXPECT_EQ(answer.tangent[p], expected.tangent[p]) << p;
  }
}

TEST(MirroredBatch, CancelsAShearStressInEveryElement) {
  MirroredBatch mirrored(elastic(fem::Stress(-1e3, -2e3, 300)));
  Answer committed;
  mirrored.committed(committed.stress, committed.tangent);
  EXPECT_EQ(committed.stress[0], fem::Stress(-1e3, -2e3, 300));
  EXPECT_EQ(committed.stress[1], fem::Stress(-1e3, -2e3, -300));
  EXPECT_EQ(committed.stress[0][2] + committed.stress[1][2] + committed.stress[2][2] + committed.stress[3][2], 0.0);
}

/// Rotation of the mirrored point is the mirror image of the opposite rotation of the plain one.
TEST(MirroredBatch, MirrorsGradientsAndAnswers) {
  fem::Gradient h;
  h << 0.01, 0.03, -0.02, 0.005;
  fem::Gradient opposite = h;
  opposite(0, 1) = -h(0, 1);
  opposite(1, 0) = -h(1, 0);
  const auto plain = elastic(fem::Stress(-1e3, -2e3, 300));
  MirroredBatch mirrored(elastic(fem::Stress(-1e3, -2e3, 300)));
  Answer expected;
  Answer answer;
  (void)plain->evaluate(std::vector<fem::Gradient>(n, opposite), expected.stress, expected.tangent);
  (void)mirrored.evaluate(std::vector<fem::Gradient>(n, h), answer.stress, answer.tangent);
  EXPECT_EQ(answer.stress[1][0], expected.stress[1][0]);
  EXPECT_EQ(answer.stress[1][1], expected.stress[1][1]);
  EXPECT_EQ(answer.stress[1][2], -expected.stress[1][2]);
  EXPECT_NE(answer.stress[0], answer.stress[1]);
}

}  // namespace
}  // namespace voussoir::host
