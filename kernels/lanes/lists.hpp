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

/// Greater than the key of any pair.
inline constexpr std::uint32_t key_of_no_pair = 0xffffffffU;

/// Contacts and the numbers of their histories, contact by contact; keys ascend.
struct KeptContacts {
  std::span<const std::uint32_t> keys;
  const double* histories;
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

/// Finds the histories of pairs whose keys ascend, in one walk along the kept contacts. Half of the pairs have one, in
/// no order that a processor could foresee, so the walk has no branch that depends on it.
template <std::size_t numbers>
class HistoryWalk {
 public:
  explicit HistoryWalk(const KeptContacts& kept)
      : keys_(kept.keys.empty() ? &key_of_no_pair : kept.keys.data()),
        histories_(kept.keys.empty() ? none.data() : kept.histories),
        last_(kept.keys.empty() ? 0 : kept.keys.size() - 1) {}

  /// The history of a pair, or zeros.
  class History {
   public:
    History(const double* history, bool found) : history_(history), mask_(-static_cast<std::uint64_t>(found)) {}
    [[nodiscard]] double operator[](std::size_t k) const {
      return std::bit_cast<double>(std::bit_cast<std::uint64_t>(history_[k]) & mask_);
    }

   private:
    const double* history_;
    std::uint64_t mask_;
  };

  /// The history of a pair, which is zero where the pair is not kept.
  [[nodiscard]] History of(std::uint32_t key) {
    while (at_ < last_ && keys_[at_] < key) ++at_;  // rare: the contact before has been dropped
    const bool found = keys_[at_] == key;
    const History history(histories_ + numbers * at_, found);
    at_ += static_cast<std::size_t>(found) & static_cast<std::size_t>(at_ < last_);
    return history;
  }

 private:
  static constexpr std::array<double, std::max(numbers, std::size_t{1})> none{};
  const std::uint32_t* keys_;
  const double* histories_;
  std::size_t last_, at_ = 0;
};

/// Lists those of the pairs `keys` of a lane that are closer than the skin [m]. Branches and gaps are computed in
/// double and rounded once. A kept contact that is not listed has opened by more than the skin and is dropped. Each
/// pair is written at the end of the list, and the list grows where the pair is near: a branch would often be foreseen
/// wrongly.
template <class Law>
void list_pairs(LaneListOf<Law>& lane, std::span<const double> radii, double skin, std::span<const std::uint32_t> keys,
                const KeptContacts& kept) {
  using real = real_of<typename Law::Value>;
  const Cell cell(lane.cell);
  lane.pairs.resize(keys.size() + 1);
  HistoryWalk<static_cast<std::size_t>(history_size<Law>)> walk(kept);
  auto* to = lane.pairs.data();
  const double* const position = lane.position.data();
  for (const std::uint32_t key : keys) {
    const auto i = static_cast<std::size_t>(first_of(key)), j = static_cast<std::size_t>(second_of(key));
    const double sum = radii[i] + radii[j];
    const PairReference at = pair_reference(position[2 * j] - position[2 * i],
                                            position[2 * j + 1] - position[2 * i + 1], sum, cell);
    const auto history = walk.of(key);
    to->key = key;
    to->branch_x = static_cast<real>(at.branch_x);
    to->branch_y = static_cast<real>(at.branch_y);
    to->gap = static_cast<real>(at.gap);
    for (std::size_t k = 0; k < to->history.size(); ++k) to->history[k] = static_cast<real>(history[k]);
    to += static_cast<std::ptrdiff_t>(!(at.gap >= skin * (2.0 * sum + skin)));  // |b| < R + skin
  }
  lane.pairs.resize(static_cast<std::size_t>(to - lane.pairs.data()));
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

/// Writes the union of the lanes' lists into the group. All lists are walked together, and the least key at which a
/// lane stands comes next. Which lanes list it cannot be foreseen, so only rows and the end of the walk are branches.
template <class Law>
class UnionBuilder {
 public:
  using V = typename Law::Value;
  using real = real_of<V>;
  static constexpr std::size_t width = static_cast<std::size_t>(lane_count<V>);
  using Lanes = std::array<LaneListOf<Law>, width>;

  /// The lists are the same at the end.
  void build(GroupState<Law>& group, Lanes& lanes, const Packing& packing) {
    for (std::size_t l = 0; l < width; ++l) {
      lanes[l].pairs.push_back({key_of_no_pair, real(0), real(0), real(0), {}});
      next_[l] = lanes[l].pairs.data();
    }
    std::size_t count = 0, row = 0;
    group.row[0] = 0;
    for (std::uint32_t key = least(); key != key_of_no_pair; key = least()) {
      const auto i = static_cast<std::size_t>(first_of(key)), j = static_cast<std::size_t>(second_of(key));
      while (row < i) group.row[++row] = static_cast<int>(count);
      if (count == group.pairs.size()) {
        group.pairs.resize(2 * count + 64);
        group.pair_shapes.resize(2 * count + 64 + pairs_ahead);
      }
      group.pair_shapes[count] = shape_of<Law>(packing, first_of(key), second_of(key));
      fill(group.pairs[count], key, packing.radii[i] + packing.radii[j]);
      ++count;
    }
    while (row < static_cast<std::size_t>(group.n_grains)) group.row[++row] = static_cast<int>(count);
    for (auto& lane : lanes) lane.pairs.pop_back();
    group.pair_shapes.resize(std::max(group.pair_shapes.size(), count + pairs_ahead));
    for (std::size_t k = 0; k < pairs_ahead; ++k) group.pair_shapes[count + k].other_bytes = 0;
  }

 private:
  std::array<const ListedPairOf<Law>*, width> next_{};

  [[nodiscard]] std::uint32_t least() const {
    std::array<std::uint32_t, width> keys;
    for (std::size_t l = 0; l < width; ++l) keys[l] = next_[l]->key;
    for (std::size_t half = width / 2; half > 0; half /= 2) {
      for (std::size_t l = 0; l < half; ++l) keys[l] = std::min(keys[l], keys[l + half]);
    }
    return keys[0];
  }

  /// @param sum R [m]
  void fill(PairLanes<Law>& to, std::uint32_t key, double sum) {
    const ListedPairOf<Law> inert{key, real(0), real(0), static_cast<real>(sum * sum), {}};
    for (std::size_t l = 0; l < width; ++l) {
      const ListedPairOf<Law>* const own = next_[l];
      const bool lists = own->key == key;
      const ListedPairOf<Law>& from = lists ? *own : inert;
      next_[l] = own + static_cast<std::ptrdiff_t>(lists);
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
