#pragma once
/// Stress and tangent of all lanes at rest: one law call per contact with zero motion.
///
/// Love-Weber stress, eq. (3): sigma = (1/V) sum P (x) b. Contact tangent, eq. (4): D = (1/V) sum k_n n b n b + k_t t b t b,
/// symmetrised for the FEM; it is affine (too stiff by 1.2 to 3) and neglects spins.

#include "kernels/pair_sweep.hpp"

namespace voussoir::kernels {

/// Sums over all contacts; divide by the volume for stress and tangent. Voigt (xx, yy, xy), upper triangle.
template <class V>
struct Homogenised {
  SweepSums<V> sums;
  V tangent[6] = {V(0), V(0), V(0), V(0), V(0), V(0)};  ///< xxxx, xxyy, xxxy, yyyy, yyxy, xyxy [N m]
  V contacts = V(0);
};

/// k s (x) s with s = sym(direction (x) branch) in Voigt form.
template <class V>
KOKKOS_FORCEINLINE_FUNCTION void add_spring(V* tangent, const V& k, const V& dx, const V& dy, const PairGeometry<V>& at) {
  const V xx = dx * at.branch_x;
  const V yy = dy * at.branch_y;
  const V xy = V(real_of<V>(0.5)) * fused(dx, at.branch_y, dy * at.branch_x);
  const V kxx = k * xx, kyy = k * yy;
  tangent[0] = fused(kxx, xx, tangent[0]);
  tangent[1] = fused(kxx, yy, tangent[1]);
  tangent[2] = fused(kxx, xy, tangent[2]);
  tangent[3] = fused(kyy, yy, tangent[3]);
  tangent[4] = fused(kyy, xy, tangent[4]);
  tangent[5] = fused(k * xy, xy, tangent[5]);
}

/// Adds the pair to the sums; history is limited by the caps of the final positions, as the next step would.
template <class Law, class V, class real>
void homogenise_pair(Homogenised<V>& out, PairLanes<V>& pair, const PairShape<real>& shape, const PairGeometry<V>& at,
                     const CellMotion<V>& cell, const V& radius_i) {
  const V zero(0), one(1);
  const auto touching = at.gap < zero;
  CellMotion<V> still = cell;
  still.d_xx = still.d_xy = still.d_yy = zero;
  add_stress(out.sums, act<Law>(pair, shape, at, still, zero, zero, zero, zero, radius_i), at);

  const V weight = Kokkos::Experimental::condition(touching, one, zero);
  const V e = overlap_measure(at, shape);
  const V to_unit = distance_of(e, V(shape.sum_radii)).inverse_ratio * V(shape.inverse_sum);
  const V nx = at.branch_x * to_unit, ny = at.branch_y * to_unit;
  add_spring(out.tangent, weight * V(shape.normal_stiffness), nx, ny, at);
  add_spring(out.tangent, weight * V(shape.tangential_stiffness), -ny, nx, at);
  out.contacts = out.contacts + weight;
  out.sums.largest_overlap = larger(out.sums.largest_overlap, e);
}

template <class Law, class V>
Homogenised<V> homogenise(GroupState<V>& group) {
  Homogenised<V> out;
  const GrainLanes<V>* const grains = group.grains.data();
  for (std::size_t i = 0; i < static_cast<std::size_t>(group.n_grains); ++i) {
    const V radius(group.shapes[i].radius);
    for (auto p = static_cast<std::size_t>(group.row[i]); p < static_cast<std::size_t>(group.row[i + 1]); ++p) {
      PairShape<real_of<V>>& shape = group.pair_shapes[p];
      const GrainLanes<V>& gj = grains[shape.other];
      const PairGeometry<V> at =
          geometry_of(group.pairs[p], group.motion, gj.u_x - grains[i].u_x, gj.u_y - grains[i].u_y);
      homogenise_pair<Law>(out, group.pairs[p], shape, at, group.motion, radius);
    }
  }
  return out;
}

}  // namespace voussoir::kernels
