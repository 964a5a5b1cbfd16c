#pragma once
/// One RVE spread over all lanes: a lane of a vector is one of its pairs, then one of its grains. RVEs without company,
/// of packings of their own or left over from their groups, would leave all lanes but one empty otherwise. The sums
/// over the pairs of a grain, and of the RVE, are taken in the order of `sweep_pairs`, pair by pair, so that an RVE has
/// the same bits on either way.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <type_traits>
#include <vector>

#include "kernels/contact/grain_motion.hpp"
#include "kernels/contact/pair_forces.hpp"
#include "kernels/lanes/wide_lane.hpp"

namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES {

/// The constants of as many pairs as a vector has lanes (PairShape, GrainShape).
template <class Law>
struct SpreadShapes {
  using V = typename Law::Value;
  V inverse_sum, minus_inverse_sum_squared, minus_half_sum;
  V radius_first, radius_other;
  Law law;
};

/// Quantities of all pairs, quantity by quantity, with room for whole vectors.
template <class V, std::size_t quantities>
class PairTable {
 public:
  using real = real_of<V>;

  void resize(std::size_t vectors) {
    vectors_ = vectors;
    values_.assign(quantities * vectors, V(0));
  }
  [[nodiscard]] V& at(std::size_t quantity, std::size_t b) { return values_[quantity * vectors_ + b]; }
  /// The numbers of one quantity, pair by pair.
  [[nodiscard]] real* numbers(std::size_t quantity) {
    return reinterpret_cast<real*>(values_.data() + quantity * vectors_);
  }

 private:
  std::size_t vectors_ = 0;
  std::vector<V> values_;
};

/// Sets lane `l` of a law to the law of another pair, whose lanes are all alike. A law holds nothing but values.
template <class Law>
void set_lane(Law& law, std::size_t l, const Law& from) {
  using V = typename Law::Value;
  static_assert(std::is_trivially_copyable_v<Law> && sizeof(Law) % sizeof(V) == 0);
  using real = real_of<V>;
  constexpr std::size_t width = static_cast<std::size_t>(lane_count<V>);
  std::array<real, sizeof(Law) / sizeof(real)> to, other;
  std::memcpy(to.data(), &law, sizeof(Law));
  std::memcpy(other.data(), &from, sizeof(Law));
  for (std::size_t k = l; k < to.size(); k += width) to[k] = other[k];
  std::memcpy(static_cast<void*>(&law), to.data(), sizeof(Law));
}

/// Copies the history of a contact from a lane of one law to a lane of the same law over other lanes.
template <class From, class To>
void copy_history(const typename From::History& from, std::size_t l, typename To::History& to, std::size_t to_lane) {
  std::array<real_of<typename From::Value>, most_history_numbers> numbers{};
  write_history<From>(from, l, [&](int k, const auto& number) { numbers[static_cast<std::size_t>(k)] = number; });
  read_history<To>(to, to_lane, [&](int k) { return numbers[static_cast<std::size_t>(k)]; });
}

/// The pairs and grains of the RVE of a group of one lane, between two of its lists. @tparam Law over the vector;
/// @tparam Single the same law over one lane
template <class Law, class Single>
class SpreadRve {
 public:
  using V = typename Law::Value;
  using real = real_of<V>;
  using One = typename Single::Value;
  static constexpr std::size_t width = static_cast<std::size_t>(lane_count<V>);

  [[nodiscard]] bool holds() const { return holds_; }

  /// Takes the pairs and grains over from the group.
  void take(const GroupState<Single>& group) {
    rows_.assign(group.row.begin(), group.row.end());
    take_grains(group);
    take_pairs(group);
    holds_ = true;
  }

  /// Writes the motions of the grains back.
  void give_grains(GroupState<Single>& group) const {
    for (std::size_t i = 0; i < group.grains.size(); ++i) {
      const GrainLanes<V>& from = grains_[i / width];
      const std::size_t l = i % width;
      group.grains[i] = {One(from.u_x[l]),     One(from.u_y[l]),    One(from.w_x[l]),
                         One(from.w_y[l]),     One(from.spin[l]),   One(from.force_x[l]),
                         One(from.force_y[l]), One(from.torque[l]), One(from.rotation[l])};
    }
  }

  /// Writes grains and histories back; the group has them alone from now on.
  void give(GroupState<Single>& group) {
    give_grains(group);
    for (std::size_t p = 0; p < pair_count(); ++p) {
      copy_history<Law, Single>(pairs_[p / width].history, p % width, group.pairs[p].history, 0);
    }
    holds_ = false;
  }

  /// As sweep_pairs.
  template <Sweep mode>
  void sweep(const CellMotion<One>& cell, double local_damping, SweepSums<One>& sums) {
    const CellMotion<V> motion = in_all_lanes(cell);
    compare_grains();
    V largest(0);
    for (std::size_t b = 0; b < pairs_.size(); ++b) act_on<mode>(b, motion, largest);
    if constexpr (mode == Sweep::measure) {
      for (std::size_t l = 0; l < width; ++l) sums.largest_measure = larger(sums.largest_measure, One(largest[l]));
    }
    add_up<mode>(sums);
    const V damping(static_cast<real>(local_damping));
    for (std::size_t g = 0; g < grains_.size(); ++g) {
      GrainLanes<V>& grain = grains_[g];
      integrate(grain, shapes_[g], motion, damping, V(grain.force_x), V(grain.force_y), V(grain.torque));
    }
  }

 private:
  static constexpr std::size_t numbers_of_grain = sizeof(GrainLanes<V>) / sizeof(V);

  bool holds_ = false;
  std::vector<int> rows_;
  std::vector<GrainLanes<V>> grains_;  ///< `width` grains in each
  std::vector<GrainShape<V>> shapes_;  ///< of these
  std::vector<PairLanes<Law>> pairs_;  ///< `width` pairs in each; the last ones are filled up with inert ones
  std::vector<SpreadShapes<Law>> pair_shapes_;
  std::vector<std::size_t> other_;  ///< by pair: where the second grain's numbers begin
  enum Motion : std::size_t { du_x, du_y, dw_x, dw_y, spin_first, spin_other, motions };
  enum Action : std::size_t { force_x, force_y, torque_first, torque_other, branch_x, branch_y, actions };
  PairTable<V, motions> motions_;  ///< of the second grain of a pair against the first one
  PairTable<V, actions> actions_;  ///< of a pair on its grains, with its branch

  [[nodiscard]] std::size_t pair_count() const { return static_cast<std::size_t>(rows_.back()); }

  /// Where the numbers of a grain begin; they are `width` apart.
  [[nodiscard]] static std::size_t place_of(std::size_t grain) {
    return grain / width * numbers_of_grain * width + grain % width;
  }
  [[nodiscard]] real* numbers() { return reinterpret_cast<real*>(grains_.data()); }

  void take_grains(const GroupState<Single>& group) {
    const std::size_t n = group.grains.size(), blocks = (n + width - 1) / width;
    const V zero(0);
    grains_.assign(blocks, {zero, zero, zero, zero, zero, zero, zero, zero, zero});
    shapes_.assign(blocks, {zero, zero, zero, zero, zero});
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t l = i % width;
      const GrainLanes<One>& from = group.grains[i];
      GrainLanes<V>& to = grains_[i / width];
      to.u_x[l] = from.u_x[0];
      to.u_y[l] = from.u_y[0];
      to.w_x[l] = from.w_x[0];
      to.w_y[l] = from.w_y[0];
      to.spin[l] = from.spin[0];
      to.rotation[l] = from.rotation[0];
      const GrainShape<real>& shape = group.shapes[i];
      GrainShape<V>& spread = shapes_[i / width];
      spread.radius[l] = shape.radius;
      spread.mobility[l] = shape.mobility;
      spread.rotational_mobility[l] = shape.rotational_mobility;
      spread.half_mobility[l] = shape.half_mobility;
      spread.half_rotational_mobility[l] = shape.half_rotational_mobility;
    }
  }

  void take_pairs(const GroupState<Single>& group) {
    const std::size_t n = pair_count(), blocks = (n + width - 1) / width;
    const V zero(0), one(1);
    pairs_.assign(blocks, {zero, zero, one, no_history<Law>()});
    pair_shapes_.assign(blocks, {zero, zero, zero, zero, zero, Law(law_of(group.pair_shapes[0]))});
    motions_.resize(blocks);
    actions_.resize(blocks);
    other_.resize(n);
    for (std::size_t i = 0; i + 1 < rows_.size(); ++i) {
      for (auto p = static_cast<std::size_t>(rows_[i]); p < static_cast<std::size_t>(rows_[i + 1]); ++p)
        take_pair(group, i, p);
    }
  }

  void take_pair(const GroupState<Single>& group, std::size_t i, std::size_t p) {
    const std::size_t b = p / width, l = p % width;
    const PairLanes<Single>& from = group.pairs[p];
    PairLanes<Law>& to = pairs_[b];
    to.branch_x[l] = from.branch_x[0];
    to.branch_y[l] = from.branch_y[0];
    to.gap[l] = from.gap[0];
    copy_history<Single, Law>(from.history, 0, to.history, l);
    const PairShape<Single>& shape = group.pair_shapes[p];
    SpreadShapes<Law>& spread = pair_shapes_[b];
    spread.inverse_sum[l] = shape.inverse_sum;
    spread.minus_inverse_sum_squared[l] = shape.minus_inverse_sum_squared;
    spread.minus_half_sum[l] = shape.minus_half_sum;
    spread.radius_first[l] = group.shapes[i].radius;
    spread.radius_other[l] = shape.radius_other;
    set_lane(spread.law, l, Law(law_of(shape)));
    other_[p] = place_of(static_cast<std::size_t>(shape.other));
  }

  /// The constants of a law do not depend on the number of lanes.
  [[nodiscard]] static typename Law::Pair law_of(const PairShape<Single>& shape) {
    static_assert(sizeof(typename Law::Pair) == sizeof(typename Single::Pair));
    typename Law::Pair pair;
    std::memcpy(&pair, &shape.law, sizeof(pair));
    return pair;
  }

  [[nodiscard]] static CellMotion<V> in_all_lanes(const CellMotion<One>& m) {
    const auto all = [](const One& x) { return V(x[0]); };
    return {all(m.f_xx), all(m.f_xy), all(m.f_yx), all(m.f_yy), all(m.d_xy),     all(m.d_difference),
            all(m.e_xx), all(m.e_xy), all(m.e_yx), all(m.e_yy), all(m.rotation), all(m.alive)};
  }

  /// Fills `motions_`.
  void compare_grains() {
    const real* const grains = numbers();
    real* const to_u_x = motions_.numbers(du_x);
    real* const to_u_y = motions_.numbers(du_y);
    real* const to_w_x = motions_.numbers(dw_x);
    real* const to_w_y = motions_.numbers(dw_y);
    real* const first = motions_.numbers(spin_first);
    real* const second = motions_.numbers(spin_other);
    for (std::size_t i = 0; i + 1 < rows_.size(); ++i) {
      const real* const gi = grains + place_of(i);
      const real ux = gi[0], uy = gi[width], wx = gi[2 * width], wy = gi[3 * width], spin = gi[4 * width];
      for (auto p = static_cast<std::size_t>(rows_[i]); p < static_cast<std::size_t>(rows_[i + 1]); ++p) {
        const real* const gj = grains + other_[p];
        to_u_x[p] = gj[0] - ux;
        to_u_y[p] = gj[width] - uy;
        to_w_x[p] = gj[2 * width] - wx;
        to_w_y[p] = gj[3 * width] - wy;
        first[p] = spin;
        second[p] = gj[4 * width];
      }
    }
  }

  template <Sweep mode>
  void act_on(std::size_t b, const CellMotion<V>& cell, V& largest) {
    const SpreadShapes<Law>& shape = pair_shapes_[b];
    const PairGeometry<V> at = geometry_of(pairs_[b], cell, motions_.at(du_x, b), motions_.at(du_y, b));
    const PairAction<V> on = act(pairs_[b], shape, at, cell, motions_.at(dw_x, b), motions_.at(dw_y, b),
                                 rim_of(shape.radius_first, motions_.at(spin_first, b)), motions_.at(spin_other, b));
    actions_.at(force_x, b) = on.force_x;
    actions_.at(force_y, b) = on.force_y;
    actions_.at(torque_first, b) = on.torque_i;
    actions_.at(torque_other, b) = on.torque_j;
    if constexpr (mode == Sweep::measure) {
      actions_.at(branch_x, b) = at.branch_x;
      actions_.at(branch_y, b) = at.branch_y;
      largest = larger(largest, overlap_measure(at, shape));
    }
  }

  /// Adds the actions of all pairs to the sums of their grains, and to those of the RVE.
  template <Sweep mode>
  void add_up(SweepSums<One>& sums) {
    real* const grains = numbers();
    const real* const px = actions_.numbers(force_x);
    const real* const py = actions_.numbers(force_y);
    const real* const on_first = actions_.numbers(torque_first);
    const real* const on_other = actions_.numbers(torque_other);
    const real* const bx = actions_.numbers(branch_x);
    const real* const by = actions_.numbers(branch_y);
    SweepSums<One> all = sums;
    for (std::size_t i = 0; i + 1 < rows_.size(); ++i) {
      real* const gi = grains + place_of(i);
      real fx = gi[5 * width], fy = gi[6 * width], torque = gi[7 * width];
      for (auto p = static_cast<std::size_t>(rows_[i]); p < static_cast<std::size_t>(rows_[i + 1]); ++p) {
        real* const gj = grains + other_[p];
        fx = fx + px[p];
        fy = fy + py[p];
        torque = torque + on_first[p];
        gj[5 * width] = gj[5 * width] - px[p];
        gj[6 * width] = gj[6 * width] - py[p];
        gj[7 * width] = gj[7 * width] + on_other[p];
        if constexpr (mode == Sweep::measure) {
          add_stress(all, PairAction<One>{One(px[p]), One(py[p]), One(0), One(0)},
                     PairGeometry<One>{One(bx[p]), One(by[p]), One(0)});
        }
      }
      gi[5 * width] = fx;
      gi[6 * width] = fy;
      gi[7 * width] = torque;
      if constexpr (mode == Sweep::measure)
        all.force_squared = fused(One(fx), One(fx), fused(One(fy), One(fy), all.force_squared));
    }
    sums = all;
  }
};

}  // namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES
