#pragma once
/// Neighbour lists of a group. Each lane lists its own candidates anew when its own displacements require that; the
/// group walks through the union of the lists. A pair that only other lanes list has no effect in a lane, so a lane's
/// numbers never depend on its neighbours.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>
#include <vector>

#include "kernels/contact/pair_reference.hpp"
#include "kernels/contact/pair_state.hpp"
#include "kernels/lanes/neighbours.hpp"
#include "kernels/state/rve_batch.hpp"

namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES {

/// A contact with the history it carries.
template <class Law>
struct KeptContact {
  std::uint32_t key;
  HistoryNumbers<Law, double> history;
};

/// A candidate with the numbers that one lane has for it. @tparam numbers of the law's history
template <class real, std::size_t numbers>
struct ListedPair {
  std::uint32_t key;
  real branch_x, branch_y, gap;
  std::array<real, numbers> history;
};

/// One lane between two rebases. It is the same beside many lanes and beside none.
template <class real, std::size_t numbers>
struct LaneList {
  bool rebased = false;          ///< whether there was a rebase since the committed state
  std::vector<double> position;  ///< (grain, 2) at the last rebase [m]
  Mat2 cell = identity2;         ///< at the last rebase
  std::vector<ListedPair<real, numbers>> pairs;
};

template <class Law>
using ListedPairOf = ListedPair<real_of<typename Law::Value>, static_cast<std::size_t>(history_size<Law>)>;
template <class Law>
using LaneListOf = LaneList<real_of<typename Law::Value>, static_cast<std::size_t>(history_size<Law>)>;

/// Lists those of the pairs `keys` of a lane that are closer than the skin [m]. Branches and gaps are computed in
/// double and rounded once; histories come from `kept`, whose keys ascend. A kept contact that is not listed has opened
/// by more than the skin and is dropped.
template <class Law>
void list_pairs(LaneListOf<Law>& lane, std::span<const double> radii, double skin, std::span<const std::uint32_t> keys,
                const std::vector<KeptContact<Law>>& kept) {
  using real = real_of<typename Law::Value>;
  const Cell cell(lane.cell);
  lane.pairs.clear();
  lane.pairs.reserve(keys.size());
  auto from = kept.begin();
  for (const std::uint32_t key : keys) {
    const auto i = static_cast<std::size_t>(first_of(key)), j = static_cast<std::size_t>(second_of(key));
    const double sum = radii[i] + radii[j];
    const PairReference at = pair_reference(lane.position[2 * j] - lane.position[2 * i],
                                            lane.position[2 * j + 1] - lane.position[2 * i + 1], sum, cell);
    if (at.gap >= skin * (2.0 * sum + skin)) continue;  // |b| >= R + skin
    ListedPairOf<Law> pair{
        key, static_cast<real>(at.branch_x), static_cast<real>(at.branch_y), static_cast<real>(at.gap), {}};
    while (from != kept.end() && from->key < key) ++from;
    if (from != kept.end() && from->key == key) {
      for (std::size_t k = 0; k < pair.history.size(); ++k) pair.history[k] = static_cast<real>(from->history[k]);
    }
    lane.pairs.push_back(pair);
  }
}

/// The constants of pair (i, j) of a packing, for the lanes.
template <class Law>
PairShape<Law> shape_of(const Packing& packing, int i, int j) {
  const auto si = static_cast<std::size_t>(i), sj = static_cast<std::size_t>(j);
  auto shape = pair_shape<Law>(j, packing.material_of(si), packing.radii[si], packing.material_of(sj),
                               packing.radii[sj]);
  shape.other_bytes = static_cast<std::int32_t>(sj * sizeof(GrainLanes<typename Law::Value>));
  return shape;
}

/// Writes the union of the lanes' lists into the group.
template <class Law>
class UnionBuilder {
 public:
  using V = typename Law::Value;
  using real = real_of<V>;
  static constexpr int width = lane_count<V>;
  using Lanes = std::array<LaneListOf<Law>, static_cast<std::size_t>(width)>;

  void build(GroupState<Law>& group, const Lanes& lanes, const Packing& packing) {
    const int n = group.n_grains;
    cursor_.fill(0);
    listed_.assign((static_cast<std::size_t>(n) + 63) / 64, 0);
    int count = 0;
    for (int i = 0; i < n; ++i) {
      group.row[static_cast<std::size_t>(i)] = count;
      collect_row(lanes, i);
      count = append_row(group, lanes, packing, i, count);
    }
    group.row[static_cast<std::size_t>(n)] = count;
    const auto used = static_cast<std::size_t>(count);
    group.pair_shapes.resize(std::max(group.pair_shapes.size(), used + pairs_ahead));
    for (std::size_t k = 0; k < pairs_ahead; ++k) group.pair_shapes[used + k].other_bytes = 0;
  }

 private:
  std::array<std::size_t, static_cast<std::size_t>(width)> cursor_{};
  std::vector<std::uint64_t> listed_;  ///< bit j: some lane lists (i, j)

  void collect_row(const Lanes& lanes, int i) {
    for (std::size_t l = 0; l < static_cast<std::size_t>(width); ++l) {
      const auto& pairs = lanes[l].pairs;
      for (std::size_t c = cursor_[l]; c < pairs.size() && first_of(pairs[c].key) == i; ++c) {
        const auto j = static_cast<std::size_t>(second_of(pairs[c].key));
        listed_[j / 64] |= std::uint64_t{1} << (j % 64);
      }
    }
  }

  int append_row(GroupState<Law>& group, const Lanes& lanes, const Packing& packing, int i, int count) {
    for (std::size_t w = static_cast<std::size_t>(i) / 64; w < listed_.size(); ++w) {
      while (listed_[w] != 0) {
        const int j = static_cast<int>(w * 64) + std::countr_zero(listed_[w]);
        listed_[w] &= listed_[w] - 1;
        const auto at = static_cast<std::size_t>(count);
        if (at == group.pairs.size()) {
          group.pairs.resize(2 * at + 64);
          group.pair_shapes.resize(2 * at + 64 + pairs_ahead);
        }
        group.pair_shapes[at] = shape_of<Law>(packing, i, j);
        fill(group.pairs[at], lanes, pair_key(i, j), packing);
        ++count;
      }
    }
    return count;
  }

  void fill(PairLanes<Law>& to, const Lanes& lanes, std::uint32_t key, const Packing& packing) {
    const double sum = packing.radii[static_cast<std::size_t>(first_of(key))] +
                       packing.radii[static_cast<std::size_t>(second_of(key))];
    const ListedPairOf<Law> inert{key, real(0), real(0), static_cast<real>(sum * sum), {}};
    for (std::size_t l = 0; l < static_cast<std::size_t>(width); ++l) {
      const auto& pairs = lanes[l].pairs;
      const bool own = cursor_[l] < pairs.size() && pairs[cursor_[l]].key == key;
      const ListedPairOf<Law>& from = own ? pairs[cursor_[l]++] : inert;
      to.branch_x[l] = from.branch_x;
      to.branch_y[l] = from.branch_y;
      to.gap[l] = from.gap;
      read_history<Law>(to.history, l, [&](int k) { return from.history[static_cast<std::size_t>(k)]; });
    }
  }
};

/// Reads a lane's own pairs (with the histories they have now) back out of the group.
template <class Law>
void gather_lane(const GroupState<Law>& group, std::size_t lane, std::vector<ListedPairOf<Law>>& pairs) {
  pairs.clear();
  for (int i = 0; i < group.n_grains; ++i) {
    const auto si = static_cast<std::size_t>(i);
    for (auto p = static_cast<std::size_t>(group.row[si]); p < static_cast<std::size_t>(group.row[si + 1]); ++p) {
      const PairLanes<Law>& from = group.pairs[p];
      if (from.branch_x[lane] == 0 && from.branch_y[lane] == 0) continue;
      ListedPairOf<Law>& pair = pairs.emplace_back();
      pair.key = pair_key(i, group.pair_shapes[p].other);
      pair.branch_x = from.branch_x[lane];
      pair.branch_y = from.branch_y[lane];
      pair.gap = from.gap[lane];
      write_history<Law>(from.history, lane,
                         [&](int k, const auto& number) { pair.history[static_cast<std::size_t>(k)] = number; });
    }
  }
}

}  // namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES
