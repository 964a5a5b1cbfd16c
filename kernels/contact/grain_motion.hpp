#pragma once
/// One grain under the sum of its forces; docs/explanation/engine.md, "Dynamic relaxation".

#include "kernels/contact/pair_state.hpp"

namespace voussoir::kernels {

/// A velocity component after the forces of one step have acted. Local damping (Cundall) reduces a force along the
/// mid-step velocity by the share lambda, and raises a force against that velocity by the same share.
template <class V>
KOKKOS_FORCEINLINE_FUNCTION V kicked(const V& velocity, const V& force, const V& mobility, const V& half_mobility,
                                     const V& damping) {
  const V mid = fused(half_mobility, force, velocity);
  return fused(mobility, force - Kokkos::copysign(damping * force, mid), velocity);
}

/// Changes one grain's velocities by the summed force and its positions by the velocities, and clears the sums. A lane
/// that is not alive stays where it is.
template <class V, class real>
KOKKOS_FORCEINLINE_FUNCTION void integrate(GrainLanes<V>& grain, const GrainShape<real>& shape,
                                           const CellMotion<V>& cell, const V& damping, const V& fx, const V& fy,
                                           const V& torque) {
  const V zero(0);
  const V a(shape.mobility), half_a(shape.half_mobility);
  const V wx = grain.w_x;
  const V wy = grain.w_y;
  // A rattler (a grain without force and torque) loses a tenth of its velocity.
  const V kept = choose_if_zero(fx, fy, torque, V(real(0.9)) * cell.alive, cell.alive);
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

}  // namespace voussoir::kernels
