#pragma once
/// One step of all grains of a group: contacts, law, forces, integration; kernels/README.md, "One step".
///
/// A half list sorted by i < j: grain i gathers its force in registers, and is integrated right after its last pair,
/// since every pair (h, i) with h < i stands in an earlier row. No wrap, no square root, no division in the loop.

#include <cstddef>

#include "kernels/contact/pair_state.hpp"

namespace voussoir::kernels {

/// What a sweep does besides advancing.
enum class Sweep {
  advance,  ///< nothing else
  measure,  ///< also sums stress and unbalanced force
};

/// Distances of a pair, with y = R/|b|; 0, 0 and 1/R in lanes that do not touch.
template <class V>
struct PairDistance {
  V overlap;         ///< q = delta/R = 1 - 1/y [-]
  V excess;          ///< z = y - 1 = delta/|b| [-]
  V inverse_length;  ///< y/R = 1/|b| [1/m]
};

/// z/e as a polynomial in e, z = (1 - e)^(-1/2) - 1: the leading terms exact, the others fitted over 0 .. 0.51 to
/// relative errors that grow with e. Up to 1, 10, 20 and 30 % overlap, where an RVE is given up: in float 3e-10, 9e-7,
/// 5e-6 and 1.2e-5, in double 5e-15, 5e-9, 2e-7 and 1.4e-6; those of q, y and 1/|b| are smaller.
template <class V>
KOKKOS_FORCEINLINE_FUNCTION V excess_over(const V& e, const V& e2) {
  using real = real_of<V>;
  const auto c = [](double x) { return V(static_cast<real>(x)); };
  const V e4 = e2 * e2;
  const V p0 = fused(c(0.375), e, c(0.5));
  if constexpr (sizeof(real) == sizeof(float)) {
    const V p2 = fused(c(0.273604941), e, c(0.312499764));
    const V p4 = fused(c(0.338042773), e, c(0.236938801));
    const V p6 = fused(c(0.97745921), e, c(-0.282095656));
    return fused(fused(p6, e2, p4), e4, fused(p2, e2, p0));
  } else {
    const V p2 = fused(c(0.2734375), e, c(0.3125));
    const V p4 = fused(c(0.2255849802289785), e, c(0.246093750790672));
    const V p6 = fused(c(0.1864639065391075), e, c(0.209713862168221));
    const V p8 = fused(c(0.8810090424314304), e2, fused(c(-0.2865442362287911), e, c(0.2963936109142559)));
    return fused(fused(p8, e2, p6), e4 * e2, fused(fused(p4, e2, p2), e2, p0));
  }
}

/// e = -g/R^2, then z, then q = z/y = e - (1 - e) z: the subtraction halves e and loses nothing.
template <class V, class real>
KOKKOS_FORCEINLINE_FUNCTION PairDistance<V> distance_of(const V& gap, const PairShape<real>& shape) {
  const auto touches = gap < V(0);
  const V e = gap * V(shape.minus_inverse_sum_squared);
  const V z = Kokkos::Experimental::condition(touches, e * excess_over(e, e * e), V(0));
  const V q = Kokkos::Experimental::condition(touches, fused(e - V(1), z, e), V(0));
  return {q, z, fused(z, V(shape.inverse_sum), V(shape.inverse_sum))};
}

/// Force on i, and torques on both, of one pair.
template <class V>
struct PairAction {
  V force_x, force_y, torque_i, torque_j;
};

/// Current branch and squared gap of a pair.
template <class V>
struct PairGeometry {
  V branch_x, branch_y, gap;
};

template <class V>
KOKKOS_FORCEINLINE_FUNCTION PairGeometry<V> geometry_of(const PairLanes<V>& pair, const CellMotion<V>& cell,
                                                        const V& du_x, const V& du_y) {
  const V dx = fused(cell.f_xx, pair.branch_x, fused(cell.f_xy, pair.branch_y, du_x));
  const V dy = fused(cell.f_yx, pair.branch_x, fused(cell.f_yy, pair.branch_y, du_y));
  const V two(2);
  return {pair.branch_x + dx, pair.branch_y + dy,
          fused(dx, fused(two, pair.branch_x, dx), fused(dy, fused(two, pair.branch_y, dy), pair.gap))};
}

/// e = -g/R^2 of a pair; 0 in lanes that do not touch: no overlap, no force, no history.
template <class V, class real>
KOKKOS_FORCEINLINE_FUNCTION V overlap_measure(const PairGeometry<V>& at, const PairShape<real>& shape) {
  return Kokkos::Experimental::condition(at.gap < V(0), at.gap * V(shape.minus_inverse_sum_squared), V(0));
}

template <class Law, class V, class real>
KOKKOS_FORCEINLINE_FUNCTION Law law_of(const PairShape<real>& shape) {
  return {V(shape.normal_stiffness), V(shape.tangential_stiffness), V(shape.rolling_stiffness), V(shape.tangential_cap),
          V(shape.moment_cap)};
}

/// What a grain brings to its pairs that turns on its radius.
template <class V>
struct GrainRim {
  V radius;  ///< [m]
  V spin;    ///< [rad/step]
  V rolled;  ///< radius * spin, the way of its rim [m/step]
};

template <class V>
KOKKOS_FORCEINLINE_FUNCTION GrainRim<V> rim_of(const V& radius, const V& spin) {
  return {radius, spin, radius * spin};
}

/// Law and forces of a pair that touches in at least one lane. (dw_x, dw_y) is w_j - w_i. The branch is not made a unit
/// vector: what is needed of n and t is a product with it over |b|. D b is taken less D_xx b, which has no part along
/// t.
template <class Law, class V, class real>
KOKKOS_FORCEINLINE_FUNCTION PairAction<V> act(PairLanes<V>& pair, const PairShape<real>& shape,
                                              const PairGeometry<V>& at, const CellMotion<V>& cell, const V& dw_x,
                                              const V& dw_y, const GrainRim<V>& i, const V& spin_j) {
  const PairDistance<V> distance = distance_of(at.gap, shape);
  const V vx = fused(cell.d_xy, at.branch_y, dw_x);
  const V vy = fused(cell.d_xy, at.branch_x, fused(cell.d_difference, at.branch_y, dw_y));
  const V across = fused(vy, at.branch_x, -(vx * at.branch_y));
  const V to_sliding = fused(distance.excess, distance.inverse_length, distance.inverse_length);  // y/|b|
  const V radius_j = V(shape.radius_other);
  const V sliding = fused(to_sliding, across, -fused(radius_j, spin_j, i.rolled));

  const Law law = law_of<Law, V>(shape);
  typename Law::History history{pair.tangential, pair.moment};
  const ContactForce<V> f = law({distance.overlap, distance.excess, sliding, spin_j - i.spin}, history);
  pair.tangential = history.tangential;
  if constexpr (Law::has_rolling) pair.moment = history.moment;

  const V minus_half_sum(shape.minus_half_sum);
  const V arm_i = fused(minus_half_sum, distance.overlap, i.radius);
  const V arm_j = fused(minus_half_sum, distance.overlap, radius_j);
  const V along = f.normal_to_branch;
  const V aside = f.tangential * distance.inverse_length;
  PairAction<V> action{-fused(aside, at.branch_y, along * at.branch_x),
                       fused(aside, at.branch_x, -(along * at.branch_y)), V(0), V(0)};
  if constexpr (Law::has_rolling) {
    action.torque_i = fused(arm_i, f.tangential, f.moment);
    action.torque_j = fused(arm_j, f.tangential, -f.moment);
  } else {
    action.torque_i = arm_i * f.tangential;
    action.torque_j = arm_j * f.tangential;
  }
  return action;
}

template <class V>
KOKKOS_FORCEINLINE_FUNCTION void add_stress(SweepSums<V>& sums, const PairAction<V>& p, const PairGeometry<V>& at) {
  sums.stress_xx = fused(p.force_x, at.branch_x, sums.stress_xx);
  sums.stress_xy = fused(p.force_x, at.branch_y, sums.stress_xy);
  sums.stress_yx = fused(p.force_y, at.branch_x, sums.stress_yx);
  sums.stress_yy = fused(p.force_y, at.branch_y, sums.stress_yy);
}

/// A velocity component after the kick of one step. Local damping (Cundall): a force that works on the mid-step
/// velocity is cut by lambda, the other raised.
template <class V>
KOKKOS_FORCEINLINE_FUNCTION V kicked(const V& velocity, const V& force, const V& mobility, const V& half_mobility,
                                     const V& damping) {
  const V mid = fused(half_mobility, force, velocity);
  return fused(mobility, force - Kokkos::copysign(damping * force, mid), velocity);
}

/// Kick and drift of one grain under the summed force; clears the sums. A lane that is not alive stays where it is.
template <class V, class real>
KOKKOS_FORCEINLINE_FUNCTION void integrate(GrainLanes<V>& grain, const GrainShape<real>& shape,
                                           const CellMotion<V>& cell, const V& damping, const V& fx, const V& fy,
                                           const V& torque) {
  const V zero(0);
  const V a(shape.mobility), half_a(shape.half_mobility);
  const V wx = grain.w_x;
  const V wy = grain.w_y;
  const V kept = choose_if_zero(fx, fy, torque, V(real(0.9)) * cell.alive, cell.alive);  // less of a rattler's velocity
  const V new_x = kept * fused(-cell.rotation, wy, kicked(wx, fx, a, half_a, damping));
  const V new_y = kept * fused(cell.rotation, wx, kicked(wy, fy, a, half_a, damping));
  const V spin = kept *
                 kicked(grain.spin, torque, V(shape.rotational_mobility), V(shape.half_rotational_mobility), damping);
  const V ux = grain.u_x;
  const V uy = grain.u_y;
  grain.u_x = ux + fused(cell.e_xx, ux, fused(cell.e_xy, uy, new_x));
  grain.u_y = uy + fused(cell.e_yx, ux, fused(cell.e_yy, uy, new_y));
  grain.w_x = new_x;
  grain.w_y = new_y;
  grain.spin = spin;
  grain.rotation = grain.rotation + spin;
  grain.force_x = zero;
  grain.force_y = zero;
  grain.torque = zero;
}

/// Asks for what the sweep will read of a grain; its place in memory cannot be foreseen by the hardware. Measured: 4 %
/// of a step.
template <class V>
KOKKOS_FORCEINLINE_FUNCTION void fetch_ahead([[maybe_unused]] const GrainLanes<V>& grain) {
#if defined(__GNUC__) && !defined(__CUDA_ARCH__)
  const char* const bytes = reinterpret_cast<const char*>(&grain);
  for (std::size_t at = 0; at < offsetof(GrainLanes<V>, force_x); at += 64) __builtin_prefetch(bytes + at);
#endif
}

/// One step of the whole group. Sums are filled for `Sweep::measure` only.
template <Sweep mode, class Law, class V>
void sweep_pairs(GroupState<V>& group, SweepSums<V>& sums) {
  using real = real_of<V>;
  GrainLanes<V>* const grains = group.grains.data();
  PairLanes<V>* const pairs = group.pairs.data();
  PairShape<real>* const pair_shapes = group.pair_shapes.data();
  const GrainShape<real>* const shapes = group.shapes.data();
  const int* const row = group.row.data();
  const auto grain_at = [grains](std::int32_t bytes) -> GrainLanes<V>& {
    return *reinterpret_cast<GrainLanes<V>*>(reinterpret_cast<char*>(grains) + bytes);
  };
  const CellMotion<V> cell = group.motion;
  const V damping(static_cast<real>(group.local_damping));

  for (int i = 0; i < group.n_grains; ++i) {
    GrainLanes<V>& gi = grains[i];
    const V ux = gi.u_x, uy = gi.u_y, wx = gi.w_x, wy = gi.w_y;
    const GrainRim<V> rim = rim_of(V(shapes[i].radius), gi.spin);
    V fx = gi.force_x, fy = gi.force_y, torque = gi.torque;
    PairLanes<V>* pair = pairs + row[i];
    const PairShape<real>* const last = pair_shapes + row[i + 1];
    for (PairShape<real>* shape = pair_shapes + row[i]; shape != last; ++shape, ++pair) {
      fetch_ahead(grain_at(shape[pairs_ahead].other_bytes));
      GrainLanes<V>& gj = grain_at(shape->other_bytes);
      const PairGeometry<V> at = geometry_of(*pair, cell, gj.u_x - ux, gj.u_y - uy);
      const bool touches = Kokkos::Experimental::any_of(at.gap < V(0));
      if (!touches && shape->active == 0) continue;
      shape->active = touches ? 1 : 0;
      const PairAction<V> action = act<Law>(*pair, *shape, at, cell, gj.w_x - wx, gj.w_y - wy, rim, gj.spin);
      fx = fx + action.force_x;
      fy = fy + action.force_y;
      torque = torque + action.torque_i;
      gj.force_x = gj.force_x - action.force_x;
      gj.force_y = gj.force_y - action.force_y;
      gj.torque = gj.torque + action.torque_j;
      if constexpr (mode == Sweep::measure) {
        add_stress(sums, action, at);
        sums.largest_overlap = larger(sums.largest_overlap, overlap_measure(at, *shape));
      }
    }
    if constexpr (mode == Sweep::measure) sums.force_squared = fused(fx, fx, fused(fy, fy, sums.force_squared));
    integrate(gi, shapes[i], cell, damping, fx, fy, torque);
  }
}

}  // namespace voussoir::kernels
