#pragma once
/// One step of all grains of a group: contacts, law, forces, integration; kernels/README.md, "One step".
///
/// A half list sorted by i < j: grain i gathers its force in registers, and is integrated right after its last pair, since
/// every pair (h, i) with h < i stands in an earlier row. No wrap, no square root, no division in the loop.

#include <cstddef>

#include "kernels/group_state.hpp"

namespace voussoir::kernels {

/// What a sweep does besides advancing.
enum class Sweep {
  advance,  ///< nothing else
  measure,  ///< also sums stress and unbalanced force
};

/// Distances of a pair, from e = -g/R^2 (0 < e < 0.51 in contact, where overlaps reach 0.3; e = 0 without).
template <class V>
struct PairDistance {
  V overlap;        ///< delta = R q, q = 1 - sqrt(1 - e) [m]
  V inverse_ratio;  ///< y = R/|b| = (1 - e)^(-1/2)
};

/// Series of both, sharpened by Newton: twice on y^2 (1 - e) = 1, once on q (2 - q) = e, whose slope is 2/y. Relative errors of
/// y and q: rounding at 1 % overlap, 1e-10 and 2e-8 at 10 %, 3e-5 and 4e-5 at 30 %, where an RVE is given up.
template <class V>
KOKKOS_FORCEINLINE_FUNCTION PairDistance<V> distance_of(const V& e, const V& sum_radii) {
  using real = real_of<V>;
  const V half(real(0.5)), three_halves(real(1.5));
  const V half_x = fused(e, -half, half);
  V y = fused(e, fused(e, V(real(3.0 / 8)), half), V(real(1)));
  y = y * fused(-half_x, y * y, three_halves);
  y = y * fused(-half_x, y * y, three_halves);
  V q = e * fused(e, fused(e, V(real(1.0 / 16)), V(real(1.0 / 8))), half);
  q = fused(half * y, fused(q, q - V(real(2)), e), q);
  return {sum_radii * q, y};
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
KOKKOS_FORCEINLINE_FUNCTION PairGeometry<V> geometry_of(const PairLanes<V>& pair, const CellMotion<V>& cell, const V& du_x,
                                                        const V& du_y) {
  const V dx = fused(cell.f_xx, pair.branch_x, fused(cell.f_xy, pair.branch_y, du_x));
  const V dy = fused(cell.f_yx, pair.branch_x, fused(cell.f_yy, pair.branch_y, du_y));
  const V bx = pair.branch_x + dx;
  const V by = pair.branch_y + dy;
  return {bx, by, fused(dx, bx + pair.branch_x, fused(dy, by + pair.branch_y, pair.gap))};
}

/// e = -g/R^2 of a pair; 0 in lanes that do not touch: no overlap, no force, no history.
template <class V, class real>
KOKKOS_FORCEINLINE_FUNCTION V overlap_measure(const PairGeometry<V>& at, const PairShape<real>& shape) {
  return Kokkos::Experimental::condition(at.gap < V(0), at.gap * V(shape.minus_inverse_sum_squared), V(0));
}

template <class Law, class V, class real>
KOKKOS_FORCEINLINE_FUNCTION Law law_of(const PairShape<real>& shape) {
  return {V(shape.normal_stiffness), V(shape.tangential_stiffness), V(shape.rolling_stiffness), V(shape.friction),
          V(shape.rolling_arm)};
}

/// Law and forces of a pair that touches in at least one lane. (dw_x, dw_y) is w_j - w_i.
template <class Law, class V, class real>
KOKKOS_FORCEINLINE_FUNCTION PairAction<V> act(PairLanes<V>& pair, const PairShape<real>& shape, const PairGeometry<V>& at,
                                              const CellMotion<V>& cell, const V& dw_x, const V& dw_y, const V& spin_i,
                                              const V& spin_j, const V& radius_i) {
  const PairDistance<V> distance = distance_of(overlap_measure(at, shape), V(shape.sum_radii));
  const V to_unit = distance.inverse_ratio * V(shape.inverse_sum);
  const V nx = at.branch_x * to_unit;
  const V ny = at.branch_y * to_unit;

  const V vx = fused(cell.d_xx, at.branch_x, fused(cell.d_xy, at.branch_y, dw_x));
  const V vy = fused(cell.d_xy, at.branch_x, fused(cell.d_yy, at.branch_y, dw_y));
  const V along = fused(vy, nx, -(vx * ny));
  const V radius_j = V(shape.radius_other);
  const V sliding = fused(distance.inverse_ratio, along, -fused(radius_i, spin_i, radius_j * spin_j));

  const Law law = law_of<Law, V>(shape);
  typename Law::History history{pair.tangential, pair.moment};
  const ContactForce<V> f = law({distance.overlap, sliding, spin_j - spin_i}, history);
  pair.tangential = history.tangential;
  if constexpr (Law::has_rolling) pair.moment = history.moment;

  const V minus_half(real(-0.5));
  const V arm_i = fused(minus_half, distance.overlap, radius_i);
  const V arm_j = fused(minus_half, distance.overlap, radius_j);
  PairAction<V> action{-fused(f.normal, nx, f.tangential * ny), fused(f.tangential, nx, -(f.normal * ny)),
                       arm_i * f.tangential, arm_j * f.tangential};
  if constexpr (Law::has_rolling) {
    action.torque_i = action.torque_i + f.moment;
    action.torque_j = action.torque_j - f.moment;
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

/// Local damping (Cundall): a component that works on the mid-step velocity is cut by lambda, the other raised.
template <class V>
KOKKOS_FORCEINLINE_FUNCTION V damped(const V& force, const V& velocity, const V& mobility, const V& damping) {
  const V mid = fused(V(real_of<V>(0.5)) * mobility, force, velocity);
  return force - Kokkos::copysign(damping * force, mid);
}

/// Kick and drift of one grain under the summed force; clears the sums.
template <class V, class real>
KOKKOS_FORCEINLINE_FUNCTION void integrate(GrainLanes<V>& grain, const GrainShape<real>& shape, const CellMotion<V>& cell,
                                           const V& damping, const V& fx, const V& fy, const V& torque) {
  const V a = V(shape.mobility) * cell.alive;
  const V ar = V(shape.rotational_mobility) * cell.alive;
  const V zero(0);
  const V rattles =
      Kokkos::Experimental::condition((fx == zero) && (fy == zero) && (torque == zero), V(real(0.9)), V(real(1)));
  const V wx = grain.w_x;
  const V wy = grain.w_y;
  const V kicked_x = fused(a, damped(fx, wx, a, damping), wx);
  const V kicked_y = fused(a, damped(fy, wy, a, damping), wy);
  const V new_x = rattles * fused(-cell.rotation, wy, kicked_x);
  const V new_y = rattles * fused(cell.rotation, wx, kicked_y);
  const V spin = rattles * fused(ar, damped(torque, grain.spin, ar, damping), grain.spin);
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

/// Asks for what the sweep will read of a grain; its place in memory cannot be foreseen by the hardware. Measured: 4 % of a step.
template <class V>
KOKKOS_FORCEINLINE_FUNCTION void fetch_ahead([[maybe_unused]] const GrainLanes<V>& grain) {
#if defined(__GNUC__) && !defined(__CUDA_ARCH__)
  const char* const bytes = reinterpret_cast<const char*>(&grain);
  for (std::size_t at = 0; at < offsetof(GrainLanes<V>, rotation); at += 64) __builtin_prefetch(bytes + at);
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
  const CellMotion<V> cell = group.motion;
  const V damping(static_cast<real>(group.local_damping));

  for (int i = 0; i < group.n_grains; ++i) {
    GrainLanes<V>& gi = grains[i];
    const V ux = gi.u_x, uy = gi.u_y, wx = gi.w_x, wy = gi.w_y, spin = gi.spin;
    const V radius(shapes[i].radius);
    V fx = gi.force_x, fy = gi.force_y, torque = gi.torque;
    for (int p = row[i]; p < row[i + 1]; ++p) {
      PairShape<real>& shape = pair_shapes[p];
      fetch_ahead(grains[pair_shapes[p + pairs_ahead].other]);
      GrainLanes<V>& gj = grains[shape.other];
      const PairGeometry<V> at = geometry_of(pairs[p], cell, gj.u_x - ux, gj.u_y - uy);
      const bool touches = Kokkos::Experimental::any_of(at.gap < V(0));
      if (!touches && shape.active == 0) continue;
      shape.active = touches ? 1 : 0;
      const PairAction<V> action =
          act<Law>(pairs[p], shape, at, cell, gj.w_x - wx, gj.w_y - wy, spin, gj.spin, radius);
      fx = fx + action.force_x;
      fy = fy + action.force_y;
      torque = torque + action.torque_i;
      gj.force_x = gj.force_x - action.force_x;
      gj.force_y = gj.force_y - action.force_y;
      gj.torque = gj.torque + action.torque_j;
      if constexpr (mode == Sweep::measure) {
        add_stress(sums, action, at);
        sums.largest_overlap = larger(sums.largest_overlap, overlap_measure(at, shape));
      }
    }
    if constexpr (mode == Sweep::measure) sums.force_squared = fused(fx, fx, fused(fy, fy, sums.force_squared));
    integrate(gi, shapes[i], cell, damping, fx, fy, torque);
  }
}

}  // namespace voussoir::kernels
