// The lists of lanes and their union, against lists made by hand.

#include "kernels/lanes/lists.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "kernels/lanes/wide_lane.hpp"
#include "tests/engine_support.hpp"

namespace voussoir::kernels {
namespace {

using Law = EngineLaw<lanes::WideLane<float>, true>;
using Alone = EngineLaw<SingleLane<float>, true>;
constexpr std::size_t width = lane_count<lanes::WideLane<float>>;

/// Four grains of radius 1 in a row, 2.1 apart, in a cell without other neighbours.
lanes::LaneListOf<Alone> row_of_four() {
  lanes::LaneListOf<Alone> lane;
  lane.cell = {40, 0, 0, 40};
  for (int i = 0; i < 4; ++i) lane.position.insert(lane.position.end(), {1 + 2.1 * i, 1});
  return lane;
}

TEST(Lists, HoldNearPairsWithTheirHistories) {
  auto lane = row_of_four();
  const std::vector<double> radii(4, 1.0), histories{1, 2, 3, 4, 5, 6};
  const std::vector<std::uint32_t> keys{pair_key(0, 1), pair_key(0, 2), pair_key(1, 2), pair_key(1, 3), pair_key(2, 3)},
      kept{pair_key(0, 2), pair_key(0, 3), pair_key(2, 3)};  // two that are too far, one of which is no candidate
  lanes::list_pairs<Alone>(lane, radii, 0.2, keys, {kept, histories.data()});
  ASSERT_EQ(lane.pairs.size(), 3U);
  EXPECT_EQ(lane.pairs[0].key, pair_key(0, 1));
  EXPECT_EQ(lane.pairs[1].key, pair_key(1, 2));
  EXPECT_EQ(lane.pairs[2].key, pair_key(2, 3));
  EXPECT_EQ(lane.pairs[0].history, (std::array<float, 2>{0, 0}));
  EXPECT_EQ(lane.pairs[1].history, (std::array<float, 2>{0, 0}));
  EXPECT_EQ(lane.pairs[2].history, (std::array<float, 2>{5, 6}));
  EXPECT_FLOAT_EQ(lane.pairs[2].branch_x, 2.1F);

  lanes::list_pairs<Alone>(lane, radii, 0.2, keys, {});  // nothing is kept
  ASSERT_EQ(lane.pairs.size(), 3U);
  EXPECT_EQ(lane.pairs[2].history, (std::array<float, 2>{0, 0}));
}

TEST(Lists, UnionHoldsEachLanesPairsInOrder) {
  constexpr int grains = 70;
  Packing packing;
  packing.radii.assign(grains, 1.0);
  std::mt19937 engine(7);
  lanes::UnionBuilder<Law>::Lanes all;
  std::set<std::uint32_t> expected;
  for (std::size_t l = 1; l < width; ++l) {  // lane 0 lists nothing
    for (int i = 0; i + 1 < grains; i += 3) {
      for (int j = i + 1; j < grains; ++j) {
        if (engine() % 8 != 0) continue;
        const auto x = static_cast<float>(l * 10000) + static_cast<float>(i * grains + j);
        all[l].pairs.push_back({pair_key(i, j), x, 1, -x, {2 * x, 3 * x}});
        expected.insert(pair_key(i, j));
      }
    }
  }
  const auto before = all;
  GroupState<Law> group;
  group.n_grains = grains;
  group.row.resize(grains + 1);
  lanes::UnionBuilder<Law>().build(group, all, packing);

  ASSERT_EQ(group.row[0], 0);
  ASSERT_EQ(static_cast<std::size_t>(group.row[grains]), expected.size());
  auto next = expected.begin();
  for (int i = 0; i < grains; ++i) {
    for (int p = group.row[static_cast<std::size_t>(i)]; p < group.row[static_cast<std::size_t>(i) + 1]; ++p, ++next) {
      EXPECT_EQ(pair_key(i, group.pair_shapes[static_cast<std::size_t>(p)].other), *next);
      EXPECT_EQ(group.pairs[static_cast<std::size_t>(p)].branch_x[0], 0.0F);
      EXPECT_EQ(group.pairs[static_cast<std::size_t>(p)].gap[0], 4.0F);
    }
  }
  std::vector<lanes::ListedPairOf<Law>> own;
  for (std::size_t l = 0; l < width; ++l) {
    lanes::gather_lane<Law>(group, l, own);
    ASSERT_EQ(own.size(), before[l].pairs.size());
    ASSERT_EQ(all[l].pairs.size(), before[l].pairs.size());
    for (std::size_t k = 0; k < own.size(); ++k) {
      const auto& pair = before[l].pairs[k];
      EXPECT_EQ(own[k].key, pair.key);
      EXPECT_EQ(own[k].branch_x, pair.branch_x);
      EXPECT_EQ(own[k].gap, pair.gap);
      EXPECT_EQ(own[k].history, pair.history);
    }
  }
}

TEST(Lists, NearestIntegersAreThoseOfTheLibrary) {
  for (const double x : {0.0, 0.4, 0.5, 0.6, 1.5, 2.5, -0.5, -1.5, -2.4, 1e6 + 0.5, -3e9 - 0.25}) {
    EXPECT_EQ(nearest_integer(x), std::nearbyint(x)) << x;
  }
}

}  // namespace
}  // namespace voussoir::kernels
