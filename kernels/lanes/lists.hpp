#pragma once
/// Neighbour lists of a group: each lane lists its own candidates (by its own displacement trigger), the group walks
/// the union. A pair that only other lanes list is inert in a lane, so a lane's numbers never depend on its neighbours.

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

namespace voussoir::kernels {

/// A contact with the history it carries.
struct KeptContact {
  std::uint32_t key;
  double tangential;
  double moment;
};

/// A candidate as one lane sees it.
template <class real>
struct ListedPair {
  std::uint32_t key;
  real branch_x, branch_y, gap, tangential, moment;
};

/// One lane between two rebases.
template <class real>
struct LaneList {
  std::vector<double> position;  ///< (grain, 2) at the last rebase [m]
  Mat2 cell = identity2;         ///< at the last rebase
  std::vector<ListedPair<real>> pairs;
};

/// Branches and gaps in double, rounded once; histories from `kept` (ascending keys; a kept contact that is no
/// candidate has opened by more than the skin and is dropped).
template <class real>
void list_pairs(LaneList<real>& lane, std::span<const double> radii, std::span<const std::uint32_t> keys,
                std::span<const KeptContact> kept) {
  const Cell cell(lane.cell);
  lane.pairs.clear();
  lane.pairs.reserve(keys.size());
  auto from = kept.begin();
  for (const std::uint32_t key : keys) {
    const auto i = static_cast<std::size_t>(first_of(key)), j = static_cast<std::size_t>(second_of(key));
    const PairReference at = pair_reference(lane.position[2 * j] - lane.position[2 * i],
                                            lane.position[2 * j + 1] - lane.position[2 * i + 1], radii[i] + radii[j],
                                            cell);
    ListedPair<real> pair{
        key,    static_cast<real>(at.branch_x), static_cast<real>(at.branch_y), static_cast<real>(at.gap), real(0),
        real(0)};
    while (from != kept.end() && from->key < key) ++from;
    if (from != kept.end() && from->key == key) {
      pair.tangential = static_cast<real>(from->tangential);
      pair.moment = static_cast<real>(from->moment);
    }
    lane.pairs.push_back(pair);
  }
}

/// The lanes' pair (i, j) of a packing.
template <class V>
PairShape<real_of<V>> shape_of(const Packing& packing, int i, int j) {
  const auto si = static_cast<std::size_t>(i), sj = static_cast<std::size_t>(j);
  auto shape = pair_shape<real_of<V>>(j, packing.material_of(si), packing.radii[si], packing.material_of(sj),
                                      packing.radii[sj]);
  shape.other_bytes = static_cast<std::int32_t>(sj * sizeof(GrainLanes<V>));
  return shape;
}

/// Writes the union of the lanes' lists into the group.
template <class V>
class UnionBuilder {
 public:
  using real = real_of<V>;
  static constexpr int width = lane_count<V>;
  using Lanes = std::array<LaneList<real>, static_cast<std::size_t>(width)>;

  void build(GroupState<V>& group, const Lanes& lanes, const Packing& packing) {
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

  int append_row(GroupState<V>& group, const Lanes& lanes, const Packing& packing, int i, int count) {
    for (std::size_t w = static_cast<std::size_t>(i) / 64; w < listed_.size(); ++w) {
      while (listed_[w] != 0) {
        const int j = static_cast<int>(w * 64) + std::countr_zero(listed_[w]);
        listed_[w] &= listed_[w] - 1;
        const auto at = static_cast<std::size_t>(count);
        if (at == group.pairs.size()) {
          group.pairs.resize(2 * at + 64);
          group.pair_shapes.resize(2 * at + 64 + pairs_ahead);
        }
        group.pair_shapes[at] = shape_of<V>(packing, i, j);
        fill(group.pairs[at], lanes, pair_key(i, j), packing);
        ++count;
      }
    }
    return count;
  }

  void fill(PairLanes<V>& to, const Lanes& lanes, std::uint32_t key, const Packing& packing) {
    const double sum = packing.radii[static_cast<std::size_t>(first_of(key))] +
                       packing.radii[static_cast<std::size_t>(second_of(key))];
    const ListedPair<real> inert{key, real(0), real(0), static_cast<real>(sum * sum), real(0), real(0)};
    for (std::size_t l = 0; l < static_cast<std::size_t>(width); ++l) {
      const auto& pairs = lanes[l].pairs;
      const bool own = cursor_[l] < pairs.size() && pairs[cursor_[l]].key == key;
      const ListedPair<real>& from = own ? pairs[cursor_[l]++] : inert;
      to.branch_x[l] = from.branch_x;
      to.branch_y[l] = from.branch_y;
      to.gap[l] = from.gap;
      to.tangential[l] = from.tangential;
      to.moment[l] = from.moment;
    }
  }
};

/// Reads a lane's own pairs (with the histories they have now) back out of the group.
template <class V>
void gather_lane(const GroupState<V>& group, std::size_t lane, std::vector<ListedPair<real_of<V>>>& pairs) {
  pairs.clear();
  for (int i = 0; i < group.n_grains; ++i) {
    const auto si = static_cast<std::size_t>(i);
    for (auto p = static_cast<std::size_t>(group.row[si]); p < static_cast<std::size_t>(group.row[si + 1]); ++p) {
      const PairLanes<V>& from = group.pairs[p];
      if (from.branch_x[lane] == 0 && from.branch_y[lane] == 0) continue;
      pairs.push_back({pair_key(i, group.pair_shapes[p].other), from.branch_x[lane], from.branch_y[lane],
                       from.gap[lane], from.tangential[lane], from.moment[lane]});
    }
  }
}

}  // namespace voussoir::kernels
