#pragma once
/// One step of a team's RVE, kernels/README.md "One step": all pairs at once, then all grains at once.
///
/// A pair is computed once, in the lanes' orientation i < j, and keeps its action on both grains; a grain then gathers
/// its pairs, first those whose other grain has a smaller number. This is the order of the lanes' sweep, which gives
/// the same bits and needs no atomics.

#include "kernels/contact/grain_motion.hpp"
#include "kernels/teams/team_run.hpp"

namespace voussoir::kernels::teams {

/// Computes contacts and law of all pairs. Branches and overlaps are kept for `Sweep::measure` only.
template <Sweep mode, class Run>
KOKKOS_FUNCTION void press_pairs(const Run& run) {
  using V = typename Run::V;
  const auto& at = run.at;
  const CellMotion<V>& cell = run.shared().motion;
  each(run, run.listed(), [&](int p) {
    PairShape<typename Run::Law>& shape = at.shapes(p);
    PairLanes<typename Run::Law>& pair = at.pairs(p);
    const int i = at.first(p);
    const GrainLanes<V>&gi = at.grains(i), &gj = at.grains(shape.other);
    const PairGeometry<V> now = geometry_of(pair, cell, gj.u_x - gi.u_x, gj.u_y - gi.u_y);
    const bool touches = Kokkos::Experimental::any_of(now.gap < V(0));
    if (!touches && shape.active == 0) return;  // the pair's last action was zero and still is
    shape.active = touches ? 1 : 0;
    at.actions(p) = act(pair, shape, now, cell, gj.w_x - gi.w_x, gj.w_y - gi.w_y,
                        rim_of(V(run.shape(i).radius), gi.spin), gj.spin);
    if constexpr (mode == Sweep::measure) at.branches(p) = {now.branch_x, now.branch_y, overlap_measure(now, shape)};
  });
}

/// Sums the forces on all grains and moves them. Forces are kept for `Sweep::measure` only.
template <Sweep mode, class Run>
KOKKOS_FUNCTION void move_grains(const Run& run) {
  using V = typename Run::V;
  const auto& at = run.at;
  const CellMotion<V>& cell = run.shared().motion;
  const V damping(static_cast<typename Run::real>(run.scales().local_damping));
  each(run, run.grains, [&](int i) {
    V fx(0), fy(0), torque(0);
    for (int k = incoming_begin(run, i); k < at.incoming_end(i); ++k) {
      const PairAction<V>& action = at.actions(at.incoming(k));
      fx = fx - action.force_x;
      fy = fy - action.force_y;
      torque = torque + action.torque_j;
    }
    for (int p = at.row(i); p < at.row(i + 1); ++p) {
      const PairAction<V>& action = at.actions(p);
      fx = fx + action.force_x;
      fy = fy + action.force_y;
      torque = torque + action.torque_i;
    }
    if constexpr (mode == Sweep::measure) at.forces(i) = {fx, fy};
    integrate(at.grains(i), run.shape(i), cell, damping, fx, fy, torque);
  });
}

/// Entry `q` of sum P_i b_j (xx, xy, yx, yy) in the order of the list.
template <class Run>
[[nodiscard]] KOKKOS_FUNCTION typename Run::V stress_sum(const Run& run, int q) {
  typename Run::V sum(0);
  for (int p = 0; p < run.listed(); ++p) {
    const auto& action = run.at.actions(p);
    const auto& branch = run.at.branches(p);
    sum = fused(q < 2 ? action.force_x : action.force_y, q % 2 == 0 ? branch.x : branch.y, sum);
  }
  return sum;
}

/// Sets entry `q` of the stress.
template <class V>
KOKKOS_FORCEINLINE_FUNCTION void set_stress(SweepSums<V>& sums, int q, const V& value) {
  if (q == 0) sums.stress_xx = value;
  if (q == 1) sums.stress_xy = value;
  if (q == 2) sums.stress_yx = value;
  if (q == 3) sums.stress_yy = value;
}

/// The largest measure of overlap of the listed pairs.
template <class Run>
[[nodiscard]] KOKKOS_FUNCTION typename Run::real largest_measure(const Run& run) {
  using real = typename Run::real;
  return largest<real>(run, run.listed(), [&](int p) { return static_cast<real>(run.at.branches(p).overlap); });
}

/// Computes the sums of a measuring step, each by one thread, in the order of the lanes' sweep.
template <class Run>
KOKKOS_FUNCTION void sum_step(const Run& run) {
  using V = typename Run::V;
  using real = typename Run::real;
  const auto& at = run.at;
  SweepSums<V>& sums = run.shared().sums;
  const real overlap = largest_measure(run);
  each(run, 6, [&](int q) {
    if (q < 4) set_stress(sums, q, stress_sum(run, q));
    if (q == 5) sums.largest_measure = V(overlap);
    if (q != 4) return;
    V sum(0);
    for (int i = 0; i < run.grains; ++i)
      sum = fused(at.forces(i).x, at.forces(i).x, fused(at.forces(i).y, at.forces(i).y, sum));
    sums.force_squared = sum;
  });
}

}  // namespace voussoir::kernels::teams
