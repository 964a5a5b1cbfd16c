#pragma once
/// One step of a block's RVE (docs/explanation/engine.md): all pairs at once, then all grains at once, with a barrier
/// after each.
///
/// A pair is computed once, in the orientation i < j of the lanes, and leaves its action on both grains in fast memory;
/// a grain then gathers the actions of its pairs, first those whose other grain has a smaller number. This is the order
/// of the lanes' sweep, and it needs no atomics. The constants of a pair are made anew from radii and materials at each
/// step, because that takes less time than loading them.

#include "kernels/contact/grain_motion.hpp"
#include "kernels/contact/pair_reference.hpp"
#include "kernels/device/block_sums.hpp"

namespace voussoir::kernels::device {

/// The sums of a measuring step over the pairs and grains of one thread.
template <class real>
struct StepSums {
  real stress_xx = 0, stress_xy = 0, stress_yx = 0, stress_yy = 0, force_squared = 0;
  real largest_measure = 0;
};

/// The constants of pair (i, j) in the sweep's precision.
template <class Run>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION PairShape<typename Run::Law> shape_of(const Run& run, int i, int j,
                                                                                typename Run::real radius_i,
                                                                                typename Run::real radius_j) {
  return pair_shape<typename Run::Law>(j, run.material(i), radius_i, run.material(j), radius_j);
}

/// Geometry of pair p, outside the loop of steps.
template <class Run>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION PairGeometry<typename Run::V> geometry_of_pair(
    const Run& run, int p, const CellMotion<typename Run::V>& cell) {
  using V = typename Run::V;
  const auto& from = run.at.motion[first_of(run.at.keys[p])];
  const auto& to = run.at.motion[second_of(run.at.keys[p])];
  return geometry_of(pair_of(run, p), cell, V(to.x - from.x), V(to.y - from.y));
}

/// Computes contacts and law of all pairs. Those that do not touch are computed too, and the law gives them no force: a
/// branch that most threads of a warp take costs more than the work that it saves (docs/measurements/gpu.md,
/// "Variants").
template <Sweep mode, class Run>
KOKKOS_FORCEINLINE_FUNCTION void press_pairs(const Run& run, BlockSlots<Run>& held,
                                             const CellMotion<typename Run::V>& motion,
                                             StepSums<typename Run::real>& sums) {
  using V = typename Run::V;
  using real = typename Run::real;
  const CellMotion<V> cell = motion;
  each_held(run, held.pair, run.listed, [&](int k, int p) {
    PairLanes<typename Run::Law> pair = pair_of(run, p, held.pair[k]);
    const int i = first_of(run.at.keys[p]), j = second_of(run.at.keys[p]);
    const Four<real> from = run.at.motion[i], to = run.at.motion[j];
    const PairGeometry<V> now = geometry_of(pair, cell, V(to.x - from.x), V(to.y - from.y));
    const Two<real> rim_i = run.at.rim[i], rim_j = run.at.rim[j];
    const auto shape = shape_of(run, i, j, rim_i.y, rim_j.y);
    const PairAction<V> on = act(pair, shape, now, cell, V(to.z - from.z), V(to.w - from.w),
                                 rim_of(V(rim_i.y), V(rim_i.x)), V(rim_j.x));
    held.pair[k].history = pair.history;
    run.at.action[p] = {on.force_x[0], on.force_y[0], on.torque_i[0], on.torque_j[0]};
    if constexpr (mode == Sweep::measure) {
      sums.stress_xx += on.force_x[0] * now.branch_x[0];
      sums.stress_xy += on.force_x[0] * now.branch_y[0];
      sums.stress_yx += on.force_y[0] * now.branch_x[0];
      sums.stress_yy += on.force_y[0] * now.branch_y[0];
      const real measure = overlap_measure(now, shape)[0];
      sums.largest_measure = sums.largest_measure < measure ? measure : sums.largest_measure;
    }
  });
}

/// Calls body(p, is_second) for the pairs of grain i, in the order of the list: those with grains of smaller numbers,
/// in which it is the second one, come first.
template <class Run, class Body>
KOKKOS_FORCEINLINE_FUNCTION void each_pair_of(const Run& run, int i, const Body& body) {
  const int end = static_cast<int>(run.at.row[i + 1]);
#if defined(__CUDA_ARCH__)
#pragma unroll 1
#endif
  for (int q = static_cast<int>(run.at.row[i]); q < end; ++q) {
    const auto entry = static_cast<unsigned>(run.at.entries[q]);
    body(static_cast<int>(entry >> 1U), (entry & 1U) != 0);
  }
}

/// The force on a grain, and its torque as spin: the actions of its pairs, gathered.
template <class Run>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION GrainDofs<typename Run::V> gather(const Run& run, int i) {
  using V = typename Run::V;
  using real = typename Run::real;
  real fx(0), fy(0), torque(0);
  each_pair_of(run, i, [&](int p, bool is_second) {
    const Four<real> action = run.at.action[p];  // whole, and then a choice: a load for each choice would take longer
    fx = fx + (is_second ? -action.x : action.x);
    fy = fy + (is_second ? -action.y : action.y);
    torque = torque + (is_second ? action.w : action.z);
  });
  return {V(fx), V(fy), V(torque)};
}

/// Moves all grains.
template <Sweep mode, class Run>
KOKKOS_FORCEINLINE_FUNCTION void move_grains(const Run& run, const CellMotion<typename Run::V>& motion,
                                             StepSums<typename Run::real>& sums) {
  using V = typename Run::V;
  using real = typename Run::real;
  const CellMotion<V> cell = motion;
  const V damping(static_cast<real>(run.scales().local_damping));
  each_grain(run, [&](int i) {
    const GrainDofs<V> force = gather(run, i);
    const Four<real> m = run.at.motion[i];
    const Two<real> rim = run.at.rim[i], mobility = run.at.mobility[i];
    GrainLanes<V> grain{V(m.x), V(m.y), V(m.z), V(m.w), V(rim.x), V(0), V(0), V(0), V(run.at.rotation[i])};
    const GrainShape<real> shape{rim.y, mobility.x, mobility.y, real(0.5) * mobility.x, real(0.5) * mobility.y};
    integrate(grain, shape, cell, damping, force.x, force.y, force.spin);
    run.at.motion[i] = {grain.u_x[0], grain.u_y[0], grain.w_x[0], grain.w_y[0]};
    run.at.rim[i] = {grain.spin[0], rim.y};
    run.at.rotation[i] = grain.rotation[0];
    if constexpr (mode == Sweep::measure) {
      sums.force_squared += force.x[0] * force.x[0] + force.y[0] * force.y[0];
    }
  });
}

/// The sums of all threads, for thread 0 alone.
template <class Run>
[[nodiscard]] KOKKOS_INLINE_FUNCTION SweepSums<SingleLane<double>> sums_of_all(
    const Run& run, const StepSums<typename Run::real>& own) {
  using D = SingleLane<double>;
  const double numbers[5] = {static_cast<double>(own.stress_xx), static_cast<double>(own.stress_xy),
                             static_cast<double>(own.stress_yx), static_cast<double>(own.stress_yy),
                             static_cast<double>(own.force_squared)};
  const double measure[1] = {static_cast<double>(own.largest_measure)};
  double all[5] = {}, largest[1] = {};
  reduce<Add>(run, numbers, all);
  run.block.barrier();
  reduce<Largest>(run, measure, largest);
  return {D(all[0]), D(all[1]), D(all[2]), D(all[3]), D(all[4]), D(largest[0])};
}

}  // namespace voussoir::kernels::device
