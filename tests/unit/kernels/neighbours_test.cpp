// Candidate contacts against all pairs, for gradings from one size to a ratio of 20, in straight and sheared cells.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "kernels/isa/choose_lanes.hpp"
#include "kernels/state/rve_batch.hpp"

namespace voussoir::kernels {
namespace {

struct Cloud {
  std::vector<double> positions, radii;
  Cell cell{identity2};
};

Cloud random_cloud(int grains, double size_ratio, double shear, unsigned seed) {
  std::mt19937 engine(seed);
  const auto uniform = [&] { return static_cast<double>(engine()) / 4294967296.0; };
  Cloud cloud;
  double area = 0;
  for (int i = 0; i < grains; ++i) {
    cloud.radii.push_back(std::pow(size_ratio, -uniform()));
    area += 3.0 * cloud.radii.back() * cloud.radii.back();
  }
  const double side = std::max(std::sqrt(1.2 * area), 5.0);  // above two cutoffs, where nearest images are unique
  cloud.cell = Cell(Mat2{side, shear * side, 0, 1.1 * side});
  for (int i = 0; i < grains; ++i) {
    const double a = uniform(), b = uniform();
    cloud.positions.push_back(cloud.cell.h.xx * a + cloud.cell.h.xy * b);
    cloud.positions.push_back(cloud.cell.h.yy * b);
  }
  return cloud;
}

std::vector<std::uint32_t> all_pairs(const Cloud& cloud, double skin) {
  std::vector<std::uint32_t> keys;
  for (std::size_t i = 0; i < cloud.radii.size(); ++i) {
    for (std::size_t j = i + 1; j < cloud.radii.size(); ++j) {
      double dx = cloud.positions[2 * j] - cloud.positions[2 * i],
             dy = cloud.positions[2 * j + 1] - cloud.positions[2 * i + 1];
      cloud.cell.nearest(dx, dy);
      const double reach = cloud.radii[i] + cloud.radii[j] + skin;
      if (dx * dx + dy * dy < reach * reach) keys.push_back(pair_key(static_cast<int>(i), static_cast<int>(j)));
    }
  }
  return keys;
}

struct Grading {
  double ratio, shear;
  int grains;
};

class Neighbours : public testing::TestWithParam<Grading> {};

TEST_P(Neighbours, AreThoseOfAllPairs) {
  const auto [ratio, shear, grains] = GetParam();
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Cloud cloud = random_cloud(grains, ratio, shear, seed);
    for (const LaneSet* set : compiled_lanes()) {
      if (set->isa > processor_set()) continue;
      choose_lanes(set->isa);
      std::vector<std::uint32_t> keys;
      set->find_candidates(cloud.positions, cloud.radii, cloud.cell, 0.1, keys);
      EXPECT_EQ(keys, all_pairs(cloud, 0.1)) << name_of(set->isa);
      EXPECT_FALSE(keys.empty());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Gradings, Neighbours,
                         testing::Values(Grading{1.0, 0.0, 200}, Grading{2.375, 0.0, 300}, Grading{2.375, 0.4, 300},
                                         Grading{20.0, 0.0, 500}, Grading{20.0, -0.4, 500}));

TEST(Cell, HeightsOfAShearedCell) {
  const Cell cell(Mat2{2.0, 1.0, 0.0, 3.0});
  EXPECT_NEAR(cell.height(0), 6.0 / std::hypot(1.0, 3.0), 1e-12);  // area over the length of the other vector
  EXPECT_NEAR(cell.height(1), 3.0, 1e-12);
}

}  // namespace
}  // namespace voussoir::kernels
