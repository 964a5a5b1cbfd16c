// The mirror image of a material: exact, its own inverse, nothing for a material that is its own mirror image.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "fem/linear_elastic.hpp"
#include "host/material/mirrored_batch.hpp"
#include "host/material/rve_pool.hpp"
#include "tests/host_support.hpp"

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

double value_of(const fem::MaterialBatch& batch, const std::string& name, std::size_t point) {
  for (const fem::PointField& field : batch.fields()) {
    if (field.name == name) return field.values[point];
  }
  ADD_FAILURE() << "no field " << name;
  return 0;
}

/// Fabric of eq. (22) from a snapshot's branches.
std::pair<double, double> fabric_of(const io::RveSnapshot& rve) {
  double cosine = 0, sine = 0;
  for (std::size_t c = 0; c < rve.contact_i.size(); ++c) {
    const double angle = std::atan2(rve.branch[2 * c + 1], rve.branch[2 * c]);
    cosine += std::cos(2.0 * angle);
    sine += std::sin(2.0 * angle);
  }
  return {2.0 * std::hypot(cosine, sine) / static_cast<double>(rve.contact_i.size()), 0.5 * std::atan2(sine, cosine)};
}

/// Every field of a mirrored point is what its mirrored grains have.
TEST(MirroredBatch, FieldsAreThoseOfTheMirroredGrains) {
  const PackedRve rve = small_packing(1.0e4);
  const kernels::MicrostructureRequest wanted{.fabric = true, .coordination = true, .strong_networks = true};
  const auto pool = [&] {
    return std::make_unique<RvePool>(rve, PoolOptions{.engine = {}, .microstructure = wanted}, n);
  };
  MirroredBatch mirrored(pool());
  fem::Gradient h, opposite;  // the mirror image of h: all grains move as those of point 0
  h << -2e-3, 3e-3, 1e-3, 1e-3;
  opposite << -2e-3, -3e-3, -1e-3, 1e-3;
  Answer answer;
  ASSERT_TRUE(mirrored.evaluate(std::vector<fem::Gradient>{h, opposite, h, h}, answer.stress, answer.tangent).usable);
  mirrored.commit();
  const std::vector<std::int64_t> points{0, 1, 2, 3};
  const auto snapshots = mirrored.snapshots(points);
  for (std::size_t p = 0; p < n; ++p) {
    const auto [a, direction] = fabric_of(snapshots[p]);
    EXPECT_NEAR(value_of(mirrored, "fabric_anisotropy", p), a, 1e-14) << p;
    EXPECT_NEAR(value_of(mirrored, "fabric_direction", p), direction, 1e-14) << p;
    double rotation = 0;
    for (const double angle : snapshots[p].rotation)
      rotation += angle / static_cast<double>(snapshots[p].rotation.size());
    EXPECT_NEAR(value_of(mirrored, "grain_rotation", p), rotation, 1e-16) << p;
  }
  EXPECT_GT(std::abs(value_of(mirrored, "fabric_direction", 0)), 0.1) << "along an axis: the test shows nothing";
  for (const fem::PointField& field : mirrored.fields()) {
    const bool is_odd = field.name == "fabric_direction" || field.name == "grain_rotation";
    EXPECT_EQ(field.values[1], is_odd ? -field.values[0] : field.values[0]) << field.name;
    EXPECT_EQ(field.values[2], field.values[0]) << field.name;
  }
}

}  // namespace
}  // namespace voussoir::host
