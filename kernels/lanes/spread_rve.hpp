#pragma once
/// One RVE spread over all lanes: a lane of a vector is one of its pairs, then one of its grains. RVEs without company,
/// of packings of their own or left over from their groups, would leave all lanes but one empty otherwise. The sums
/// over the pairs of a grain, and of the RVE, are taken in the order of `sweep_pairs`, pair by pair, so that an RVE has
/// the same bits on either way.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "kernels/contact/grain_motion.hpp"
#include "kernels/contact/pair_forces.hpp"
#include "kernels/lanes/spread_order.hpp"

namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES {

/// The constants of as many pairs as a vector has lanes (PairShape, GrainShape).
template <class Law>
struct SpreadShapes {
  using V = typename Law::Value;
  V inverse_sum, minus_inverse_sum_squared, minus_half_sum;
  V radius_other;
  Law law;
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
    order_.make(group.row, [&](std::size_t p) { return group.pair_shapes[p].other; });
    take_grains(group);
    take_pairs(group);
    const V zero(0);
    std::size_t most = 0;  // vectors of pairs in a window
    for (std::size_t g = 0; g < grains_.size(); g += Order::window)
      most = std::max(most,
                      order_.blocks()[std::min(g + Order::window, grains_.size())].pairs - order_.blocks()[g].pairs);
    pair_forces_.assign(order_.pair_blocks() + 1, {zero, zero});
    branches_.assign(most, {zero, zero});
    torques_first_.assign(most, zero);
    torques_other_.assign(order_.pair_blocks() + 1, zero);
    holds_ = true;
  }

  [[nodiscard]] const std::vector<GrainLanes<V>>& grains() const { return grains_; }  ///< `width` grains in each

  /// Writes grains and histories back; the group has them alone from now on.
  void give(GroupState<Single>& group) {
    for (std::size_t i = 0; i < group.grains.size(); ++i) {
      const GrainLanes<V>& from = grains_[order_.places()[i] / width];
      const std::size_t l = order_.places()[i] % width;
      group.grains[i] = {One(from.u_x[l]),     One(from.u_y[l]),    One(from.w_x[l]),
                         One(from.w_y[l]),     One(from.spin[l]),   One(from.force_x[l]),
                         One(from.force_y[l]), One(from.torque[l]), One(from.rotation[l])};
    }
    for (std::size_t p = 0; p < order_.slots().size(); ++p) {
      const std::size_t slot = order_.slots()[p];
      copy_history<Law, Single>(pairs_[slot / width].history, slot % width, group.pairs[p].history, 0);
    }
    holds_ = false;
  }

  /// As sweep_pairs.
  template <Sweep mode>
  void sweep(const CellMotion<One>& cell, double local_damping, SweepSums<One>& sums) {
    forces_ == Forces::all ? sweep_with<mode, Forces::all>(cell, local_damping, sums)
                           : sweep_with<mode, Forces::normal>(cell, local_damping, sums);
  }

 private:
  using Order = SpreadOrder<width>;
  /// The forces that the contacts have.
  enum class Forces { all, normal };

  template <Sweep mode, Forces forces>
  void sweep_with(const CellMotion<One>& cell, double local_damping, SweepSums<One>& sums) {
    const CellMotion<V> motion = in_all_lanes(cell);
    const V damping(static_cast<real>(local_damping));
    Serial serial{sums};
    V largest(0);
    for (std::size_t first = 0; first < grains_.size(); first += Order::window) {
      const std::size_t last = std::min(first + Order::window, grains_.size());
      for (std::size_t g = first; g < last; ++g)
        act_on_rows<mode, forces>(g, order_.blocks()[first].pairs, motion, largest);
      for (std::size_t g = first; g < last; ++g) {
        const GrainForces f = forces_on<forces>(g, order_.blocks()[first].pairs);
        integrate(grains_[g], shapes_[g], motion, damping, f.x, f.y, f.torque);
        show_motion<forces>(g);
        if constexpr (mode == Sweep::measure) {
          store_side_by_side(f.x, f.y, grain_forces_[g]);
          add_some(serial, g, first, last);
        }
      }
    }
    if constexpr (mode == Sweep::measure) {
      add_rest(serial);
      for (std::size_t l = 0; l < width; ++l) {
        serial.sums.largest_measure = larger(serial.sums.largest_measure, One(largest[l]));
      }
      sums = serial.sums;
    }
  }

  /// The sums of a vector of grains.
  struct GrainForces {
    V x, y, torque;
  };
  /// Sums over all pairs and grains, one after the other. Each waits for the one before, so they are taken beside the
  /// work on vectors, as far behind it as the order asks for.
  struct Serial {
    SweepSums<One> sums;
    std::size_t pairs = 0, grains = 0;  ///< that have been added
  };

  bool holds_ = false;
  Forces forces_ = Forces::all;
  Order order_;
  std::vector<GrainLanes<V>> grains_;
  std::vector<GrainShape<V>> shapes_;  ///< of these
  std::vector<PairLanes<Law>> pairs_;  ///< idle lanes hold inert pairs
  std::vector<SpreadShapes<Law>> pair_shapes_;
  std::vector<std::int32_t> others_;  ///< by slot: the place of the second grain; in idle lanes that of the first
  std::vector<Two<V>> displacements_, velocities_;  ///< of the grains
  std::vector<V> spins_;
  std::vector<Two<V>> pair_forces_;               ///< on the first grains; the last one is zero
  std::vector<Two<V>> branches_;                  ///< of measuring sweeps
  std::vector<V> torques_first_, torques_other_;  ///< the last one of the latter is zero
  std::vector<Two<V>> grain_forces_;              ///< of measuring sweeps, on the grains

  template <class T>
  [[nodiscard]] static const real* numbers(const std::vector<T>& values) {
    return reinterpret_cast<const real*>(values.data());
  }

  template <Forces forces>
  VOUSSOIR_LANES_INLINE void show_motion(std::size_t g) {
    const GrainLanes<V>& grain = grains_[g];
    store_side_by_side(grain.u_x, grain.u_y, displacements_[g]);
    if constexpr (forces == Forces::normal) return;
    store_side_by_side(grain.w_x, grain.w_y, velocities_[g]);
    spins_[g] = grain.spin;
  }

  void take_grains(const GroupState<Single>& group) {
    const std::size_t n = group.grains.size(), blocks = order_.blocks().size() - 1;
    const V zero(0);
    grains_.assign(blocks, {zero, zero, zero, zero, zero, zero, zero, zero, zero});
    shapes_.assign(blocks, {zero, zero, zero, zero, zero});
    grain_forces_.assign(blocks, {zero, zero});
    displacements_.resize(blocks, {zero, zero});
    velocities_.resize(blocks, {zero, zero});
    spins_.resize(blocks, zero);
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t at = order_.places()[i], l = at % width;
      const GrainLanes<One>& from = group.grains[i];
      GrainLanes<V>& to = grains_[at / width];
      to.u_x[l] = from.u_x[0];
      to.u_y[l] = from.u_y[0];
      to.w_x[l] = from.w_x[0];
      to.w_y[l] = from.w_y[0];
      to.spin[l] = from.spin[0];
      to.rotation[l] = from.rotation[0];
      const GrainShape<real>& shape = group.shapes[i];
      GrainShape<V>& spread = shapes_[at / width];
      spread.radius[l] = shape.radius;
      spread.mobility[l] = shape.mobility;
      spread.rotational_mobility[l] = shape.rotational_mobility;
      spread.half_mobility[l] = shape.half_mobility;
      spread.half_rotational_mobility[l] = shape.half_rotational_mobility;
    }
    for (std::size_t g = 0; g < blocks; ++g) show_motion<Forces::all>(g);
  }

  void take_pairs(const GroupState<Single>& group) {
    const std::size_t blocks = order_.pair_blocks();
    const V zero(0), one(1);
    pairs_.assign(blocks, {zero, zero, one, no_history<Law>()});
    pair_shapes_.assign(blocks, {zero, zero, zero, zero, Law(law_of(group.pair_shapes[0]))});
    others_.resize(blocks * width);
    for (std::size_t g = 0; g < grains_.size(); ++g) {
      for (std::size_t k = order_.blocks()[g].pairs * width; k < order_.blocks()[g + 1].pairs * width; ++k)
        others_[k] = static_cast<std::int32_t>(g * width + k % width);
    }
    for (std::size_t p = 0; p < order_.slots().size(); ++p) take_pair(group, p);
    const auto shapes = std::span(group.pair_shapes).first(order_.slots().size());
    const bool pushes = std::all_of(shapes.begin(), shapes.end(),
                                    [](const PairShape<Single>& shape) { return pushes_only<Single>(shape.law); });
    forces_ = pushes ? Forces::normal : Forces::all;
    if (pushes) {
      for (PairLanes<Law>& pair : pairs_) pair.history = no_history<Law>();
    }
  }

  void take_pair(const GroupState<Single>& group, std::size_t p) {
    const std::size_t slot = order_.slots()[p], b = slot / width, l = slot % width;
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
    spread.radius_other[l] = shape.radius_other;
    set_lane(spread.law, l, Law(law_of(shape)));
    others_[slot] = static_cast<std::int32_t>(order_.places()[static_cast<std::size_t>(shape.other)]);
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

  /// Computes the actions of the pairs in the rows of a vector of grains.
  template <Sweep mode, Forces forces>
  VOUSSOIR_LANES_INLINE void act_on_rows(std::size_t g, std::size_t first, const CellMotion<V>& cell, V& largest) {
    const GrainLanes<V>& gi = grains_[g];
    const V ux = gi.u_x, uy = gi.u_y, wx = gi.w_x, wy = gi.w_y;
    const GrainRim<V> rim = rim_of(shapes_[g].radius, gi.spin);
    const std::size_t end = order_.blocks()[g + 1].pairs;
    for (std::size_t b = order_.blocks()[g].pairs; b < end; ++b) {
      const std::int32_t* const other = others_.data() + b * width;
      const Two<V> u = gathered(displacements_.data(), other);
      const PairGeometry<V> at = geometry_of(pairs_[b], cell, u.x - ux, u.y - uy);
      PairAction<V> on;
      if constexpr (forces == Forces::all) {
        const Two<V> w = gathered(velocities_.data(), other);
        on = act(pairs_[b], pair_shapes_[b], at, cell, w.x - wx, w.y - wy, rim, gathered<V>(numbers(spins_), other));
        torques_first_[b - first] = on.torque_i;
        torques_other_[b] = on.torque_j;
      } else {
        on = push(pair_shapes_[b], at);
      }
      store_side_by_side(on.force_x, on.force_y, pair_forces_[b]);
      if constexpr (mode == Sweep::measure) {
        store_side_by_side(at.branch_x, at.branch_y, branches_[b - first]);
        largest = larger(largest, overlap_measure(at, pair_shapes_[b]));
      }
    }
  }

  /// Adds the actions on a vector of grains up, first those of earlier rows. A sum begins with 0, is therefore never
  /// -0, and keeps its bits where an idle lane adds or subtracts a zero.
  template <Forces forces>
  [[nodiscard]] VOUSSOIR_LANES_INLINE GrainForces forces_on(std::size_t g, std::size_t first) const {
    const auto& block = order_.blocks()[g];
    const auto& next = order_.blocks()[g + 1];
    GrainForces f{V(0), V(0), V(0)};
    for (std::size_t k = block.seconds; k < next.seconds; ++k) {
      const std::int32_t* const slots = order_.seconds().data() + k * width;
      const Two<V> force = gathered(pair_forces_.data(), slots);
      f.x = f.x - force.x;
      f.y = f.y - force.y;
      if constexpr (forces == Forces::all) f.torque = f.torque + gathered<V>(numbers(torques_other_), slots);
    }
    for (std::size_t b = block.pairs; b < next.pairs; ++b) {
      const Two<V> force = load_side_by_side(pair_forces_[b]);
      f.x = f.x + force.x;
      f.y = f.y + force.y;
      if constexpr (forces == Forces::all) f.torque = f.torque + torques_first_[b - first];
    }
    return f;
  }

  /// Goes on with the sums after grains g of a window, whose pairs are known, and so are the forces of the window
  /// before.
  VOUSSOIR_LANES_INLINE void add_some(Serial& serial, std::size_t g, std::size_t first, std::size_t last) const {
    const std::size_t before = order_.blocks()[first].whole, pairs = order_.blocks()[last].whole - before;
    const std::size_t due = before + pairs * (g + 1 - first) / (last - first);
    const std::size_t offset = 2 * order_.blocks()[first].pairs * width;
    SweepSums<One> sums = serial.sums;
    for (; serial.pairs + width <= due; serial.pairs += width) {
      for (std::size_t k = 0; k < width; ++k) add_pair(sums, serial.pairs + k, offset);
    }
    if (g + 1 == last) {
      for (; serial.pairs < due; ++serial.pairs) add_pair(sums, serial.pairs, offset);
    }
    if (serial.grains + width <= first * width) {
      for (std::size_t k = 0; k < width; ++k) add_grain(sums, serial.grains + k);
      serial.grains += width;
    }
    serial.sums = sums;
  }

  VOUSSOIR_LANES_INLINE void add_pair(SweepSums<One>& sums, std::size_t p, std::size_t offset) const {
    const std::size_t at = 2 * order_.slots()[p];
    const real* const f = numbers(pair_forces_) + at;
    const real* const b = numbers(branches_) + (at - offset);
    add_stress(sums, PairAction<One>{One(f[0]), One(f[1]), One(0), One(0)},
               PairGeometry<One>{One(b[0]), One(b[1]), One(0)});
  }
  VOUSSOIR_LANES_INLINE void add_grain(SweepSums<One>& sums, std::size_t i) const {
    const real* const f = numbers(grain_forces_) + 2 * order_.places()[i];
    sums.force_squared = fused(One(f[0]), One(f[0]), fused(One(f[1]), One(f[1]), sums.force_squared));
  }
  VOUSSOIR_LANES_INLINE void add_rest(Serial& serial) const {
    for (; serial.grains < order_.places().size(); ++serial.grains) add_grain(serial.sums, serial.grains);
  }
};

}  // namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES
