#pragma once
/// One step of all grains of a group: contacts, law, forces, integration; docs/explanation/contact_law.md, engine.md.
///
/// The list holds every pair once, with i < j, and is sorted. Grain i gathers its force in registers and is integrated
/// right after its last pair, since every pair (h, i) with h < i stands in an earlier row. The loop contains no wrap
/// into the cell, no square root and no division.

#include <cstddef>

#include "kernels/contact/grain_motion.hpp"
#include "kernels/contact/pair_forces.hpp"
#include "kernels/course/regions.hpp"

namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES {

/// Fetches the part of a grain that the sweep will read, because the hardware cannot foresee its place in memory. This
/// saves 4 % of a step.
template <class V>
KOKKOS_FORCEINLINE_FUNCTION void fetch_ahead([[maybe_unused]] const GrainLanes<V>& grain) {
#if defined(__GNUC__) && !defined(__CUDA_ARCH__)
  const char* const bytes = reinterpret_cast<const char*>(&grain);
  for (std::size_t at = 0; at < offsetof(GrainLanes<V>, force_x); at += 64) __builtin_prefetch(bytes + at);
#endif
}

/// Advances the whole group by one step. Sums are filled for `Sweep::measure` only.
template <Sweep mode, class Law, class V>
VOUSSOIR_OWN_SYMBOL void sweep_pairs(GroupState<Law>& group, SweepSums<V>& sums) {
  using real = real_of<V>;
  GrainLanes<V>* const grains = group.grains.data();
  PairLanes<Law>* const pairs = group.pairs.data();
  PairShape<Law>* const pair_shapes = group.pair_shapes.data();
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
    PairLanes<Law>* pair = pairs + row[i];
    const PairShape<Law>* const last = pair_shapes + row[i + 1];
    for (PairShape<Law>* shape = pair_shapes + row[i]; shape != last; ++shape, ++pair) {
      fetch_ahead(grain_at(shape[pairs_ahead].other_bytes));
      GrainLanes<V>& gj = grain_at(shape->other_bytes);
      const PairGeometry<V> at = geometry_of(*pair, cell, gj.u_x - ux, gj.u_y - uy);
      const bool touches = Kokkos::Experimental::any_of(at.gap < V(0));
      if (!touches && shape->active == 0) continue;
      shape->active = touches ? 1 : 0;
      const PairAction<V> action = act(*pair, *shape, at, cell, gj.w_x - wx, gj.w_y - wy, rim, gj.spin);
      fx = fx + action.force_x;
      fy = fy + action.force_y;
      torque = torque + action.torque_i;
      gj.force_x = gj.force_x - action.force_x;
      gj.force_y = gj.force_y - action.force_y;
      gj.torque = gj.torque + action.torque_j;
      if constexpr (mode == Sweep::measure) {
        add_stress(sums, action, at);
        sums.largest_measure = larger(sums.largest_measure, overlap_measure(at, *shape));
      }
    }
    if constexpr (mode == Sweep::measure) sums.force_squared = fused(fx, fx, fused(fy, fy, sums.force_squared));
    integrate(gi, shapes[i], cell, damping, fx, fy, torque);
  }
}

}  // namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES
