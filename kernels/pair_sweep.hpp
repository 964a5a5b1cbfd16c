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

/// Distances of a pair.
template <class V>
struct PairDistance {
  V overlap;         ///< delta = R q, q = 1 - sqrt(1 - e) [m]; 0 in lanes that do not touch
  V inverse_length;  ///< y/R = 1/|b|, y = R/|b| = (1 - e)^(-1/2) [1/m]
};

/// Polynomials in e = -g/R^2, y sharpened by one Newton step on y^2 (1 - e) = 1. Fitted to relative errors that grow with e, the
/// leading terms of q being exact, over 0 .. 0.51. Relative errors of 1/|b| and delta at 1, 10 and 30 % overlap, where an RVE is
/// given up: in float 1e-9 and 1e-9, 3e-7 and 8e-7, 4e-6 and 1.5e-5; in double 3e-13 and 1e-12, 1e-8 and 5e-8, 8e-7 and 1e-6.
/// Written for a short chain, since every contact waits for its own.
template <class V, class real>
KOKKOS_FORCEINLINE_FUNCTION PairDistance<V> distance_of(const V& gap, const PairShape<real>& shape) {
  const auto c = [](double x) { return V(static_cast<real>(x)); };
  const V half = c(0.5);
  const V e = gap * V(shape.minus_inverse_sum_squared);
  const V e2 = e * e;
  V y, p;
  if constexpr (sizeof(real) == sizeof(float)) {
    y = fused(fused(c(0.740802381), e, c(0.274579086)), e2, fused(e, c(0.503145986), c(1)));
    p = fused(fused(c(0.056653811), e, c(0.012835278)), e2, fused(c(0.040743878), e, c(0.062470505)));
    p = fused(p, e2, fused(c(0.125), e, half));
  } else {
    y = fused(fused(c(0.664884646), e2, fused(c(0.220350043), e, c(0.377895157))), e2, fused(e, half, c(1)));
    const V high = fused(fused(c(0.050388237365318), e, c(-0.005667201708849)), e2,
                         fused(c(0.025112181152024), e, c(0.027009218300492)));
    p = fused(high, e2 * e2, fused(fused(c(0.039067561634641), e, c(0.0625)), e2, fused(c(0.125), e, half)));
  }
  const V overlap = V(shape.sum_radii) * e * p;
  const V sharper = fused(-fused(e, -half, half), y * y, c(1.5));
  return {Kokkos::Experimental::condition(gap < V(0), overlap, V(0)), y * V(shape.inverse_sum) * sharper};
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
  return {V(shape.normal_stiffness), V(shape.tangential_stiffness), V(shape.rolling_stiffness), V(shape.friction),
          V(shape.rolling_arm)};
}

/// Law and forces of a pair that touches in at least one lane. (dw_x, dw_y) is w_j - w_i. The branch is not made a unit vector: what
/// is needed of n and t is a product with it over |b|. D b is taken less D_xx b, which has no part along t.
template <class Law, class V, class real>
KOKKOS_FORCEINLINE_FUNCTION PairAction<V> act(PairLanes<V>& pair, const PairShape<real>& shape, const PairGeometry<V>& at,
                                              const CellMotion<V>& cell, const V& dw_x, const V& dw_y, const V& spin_i,
                                              const V& spin_j, const V& radius_i) {
  const PairDistance<V> distance = distance_of(at.gap, shape);
  const V vx = fused(cell.d_xy, at.branch_y, dw_x);
  const V vy = fused(cell.d_xy, at.branch_x, fused(cell.d_difference, at.branch_y, dw_y));
  const V across = V(shape.sum_radii) * fused(vy, at.branch_x, -(vx * at.branch_y));
  const V radius_j = V(shape.radius_other);
  const V sliding =
      fused(distance.inverse_length * distance.inverse_length, across, -fused(radius_j, spin_j, radius_i * spin_i));

  const Law law = law_of<Law, V>(shape);
  typename Law::History history{pair.tangential, pair.moment};
  const ContactForce<V> f = law({distance.overlap, sliding, spin_j - spin_i}, history);
  pair.tangential = history.tangential;
  if constexpr (Law::has_rolling) pair.moment = history.moment;

  const V minus_half(real(-0.5));
  const V arm_i = fused(minus_half, distance.overlap, radius_i);
  const V arm_j = fused(minus_half, distance.overlap, radius_j);
  const V nx = at.branch_x * distance.inverse_length;
  const V ny = at.branch_y * distance.inverse_length;
  PairAction<V> action{-fused(f.tangential, ny, f.normal * nx), fused(f.tangential, nx, -(f.normal * ny)), V(0), V(0)};
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

/// A velocity component after the kick of one step. Local damping (Cundall): a force that works on the mid-step velocity is cut by
/// lambda, the other raised.
template <class V>
KOKKOS_FORCEINLINE_FUNCTION V kicked(const V& velocity, const V& force, const V& mobility, const V& damping) {
  const V mid = fused(V(real_of<V>(0.5)) * mobility, force, velocity);
  return fused(mobility, force - Kokkos::copysign(damping * force, mid), velocity);
}

/// Kick and drift of one grain under the summed force; clears the sums. A lane that is not alive stays where it is.
template <class V, class real>
KOKKOS_FORCEINLINE_FUNCTION void integrate(GrainLanes<V>& grain, const GrainShape<real>& shape, const CellMotion<V>& cell,
                                           const V& damping, const V& fx, const V& fy, const V& torque) {
  const V a(shape.mobility);
  const V kept = choose_if_zero(fx, fy, torque, V(real(0.9)) * cell.alive, cell.alive);  // less of a rattler's velocity
  const V wx = grain.w_x;
  const V wy = grain.w_y;
  const V new_x = kept * fused(-cell.rotation, wy, kicked(wx, fx, a, damping));
  const V new_y = kept * fused(cell.rotation, wx, kicked(wy, fy, a, damping));
  const V spin = kept * kicked(grain.spin, torque, V(shape.rotational_mobility), damping);
  const V ux = grain.u_x;
  const V uy = grain.u_y;
  grain.u_x = ux + fused(cell.e_xx, ux, fused(cell.e_xy, uy, new_x));
  grain.u_y = uy + fused(cell.e_yx, ux, fused(cell.e_yy, uy, new_y));
  grain.w_x = new_x;
  grain.w_y = new_y;
  grain.spin = spin;
  grain.rotation = grain.rotation + spin;
  const V zero(0);
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
