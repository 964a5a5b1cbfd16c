#pragma once
/// One step of a block's RVE, kernels/README.md "One step": all pairs at once, then all grains at once, with a barrier
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
struct StepSums {
  enum : int { stress_xx, stress_xy, stress_yx, stress_yy, force_squared, count };
  double numbers[count] = {};
  double largest_measure = 0;
};

/// The constants of pair (i, j) in the sweep's precision.
template <class Run>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION PairShape<typename Run::Law> shape_of(const Run& run, int i, int j,
                                                                                typename Run::real radius_i,
                                                                                typename Run::real radius_j) {
  return pair_shape<typename Run::Law>(j, run.material(i), radius_i, run.material(j), radius_j);
}

/// Geometry of the pair in slot k.
template <class Run>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION PairGeometry<typename Run::V> geometry_in(
    Run& run, int k, const CellMotion<typename Run::V>& cell) {
  using V = typename Run::V;
  const auto& from = run.at.motion[first_of(run.key[k])];
  const auto& to = run.at.motion[second_of(run.key[k])];
  return geometry_of(run.pair[k], cell, V(to.x - from.x), V(to.y - from.y));
}

/// Computes contacts and law of all pairs.
template <Sweep mode, class Run>
KOKKOS_FORCEINLINE_FUNCTION void press_pairs(Run& run, const CellMotion<typename Run::V>& cell, StepSums& sums) {
  using V = typename Run::V;
  using real = typename Run::real;
  each_pair(run, [&](int k, int p) {
    const int i = first_of(run.key[k]), j = second_of(run.key[k]);
    const Four<real> from = run.at.motion[i], to = run.at.motion[j];
    const PairGeometry<V> now = geometry_of(run.pair[k], cell, V(to.x - from.x), V(to.y - from.y));
    if (!(now.gap[0] < 0)) {
      run.pair[k].history = no_history<typename Run::Law>();
      run.at.action[p] = {0, 0, 0, 0};
      return;
    }
    const Two<real> rim_i = run.at.rim[i], rim_j = run.at.rim[j];
    const auto shape = shape_of(run, i, j, rim_i.y, rim_j.y);
    const PairAction<V> on = act(run.pair[k], shape, now, cell, V(to.z - from.z), V(to.w - from.w),
                                 rim_of(V(rim_i.y), V(rim_i.x)), V(rim_j.x));
    run.at.action[p] = {on.force_x[0], on.force_y[0], on.torque_i[0], on.torque_j[0]};
    if constexpr (mode == Sweep::measure) {
      const double fx = static_cast<double>(on.force_x[0]), fy = static_cast<double>(on.force_y[0]);
      const double bx = static_cast<double>(now.branch_x[0]), by = static_cast<double>(now.branch_y[0]);
      sums.numbers[StepSums::stress_xx] += fx * bx;
      sums.numbers[StepSums::stress_xy] += fx * by;
      sums.numbers[StepSums::stress_yx] += fy * bx;
      sums.numbers[StepSums::stress_yy] += fy * by;
      const double measure = static_cast<double>(overlap_measure(now, shape)[0]);
      sums.largest_measure = Largest()(sums.largest_measure, measure);
    }
  });
}

/// Calls body(p) for the pairs of grain i with grains of smaller numbers.
template <class Run, class Body>
KOKKOS_FORCEINLINE_FUNCTION void each_incoming(const Run& run, int i, const Body& body) {
  const int end = static_cast<int>(run.at.incoming_end[i]);
  for (int q = i == 0 ? 0 : static_cast<int>(run.at.incoming_end[i - 1]); q < end; ++q)
    body(static_cast<int>(run.at.incoming[q]));
}
/// Calls body(p) for the pairs of grain i with grains of larger numbers.
template <class Run, class Body>
KOKKOS_FORCEINLINE_FUNCTION void each_own(const Run& run, int i, const Body& body) {
  const int end = static_cast<int>(run.at.row[i + 1]);
  for (int p = static_cast<int>(run.at.row[i]); p < end; ++p) body(p);
}

/// The force on a grain, and its torque as spin: the actions of its pairs, gathered.
template <class Run>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION GrainDofs<typename Run::V> gather(const Run& run, int i) {
  using V = typename Run::V;
  using real = typename Run::real;
  real fx(0), fy(0), torque(0);
  each_incoming(run, i, [&](int p) {
    const Four<real> action = run.at.action[p];
    fx = fx - action.x;
    fy = fy - action.y;
    torque = torque + action.w;
  });
  each_own(run, i, [&](int p) {
    const Four<real> action = run.at.action[p];
    fx = fx + action.x;
    fy = fy + action.y;
    torque = torque + action.z;
  });
  return {V(fx), V(fy), V(torque)};
}

/// Moves all grains.
template <Sweep mode, class Run>
KOKKOS_FORCEINLINE_FUNCTION void move_grains(Run& run, const CellMotion<typename Run::V>& cell, StepSums& sums) {
  using V = typename Run::V;
  using real = typename Run::real;
  const V damping(static_cast<real>(run.scales().local_damping));
  each_grain(run, [&](int k, int i) {
    const GrainDofs<V> force = gather(run, i);
    GrainOwn<real>& own = run.own[k];
    const Four<real> m = run.at.motion[i];
    const Two<real> rim = run.at.rim[i];
    GrainLanes<V> grain{V(m.x), V(m.y), V(m.z), V(m.w), V(rim.x), V(0), V(0), V(0), V(own.rotation)};
    const GrainShape<real> shape{rim.y, own.mobility, own.rotational_mobility, real(0.5) * own.mobility,
                                 real(0.5) * own.rotational_mobility};
    integrate(grain, shape, cell, damping, force.x, force.y, force.spin);
    run.at.motion[i] = {grain.u_x[0], grain.u_y[0], grain.w_x[0], grain.w_y[0]};
    run.at.rim[i] = {grain.spin[0], rim.y};
    own.rotation = grain.rotation[0];
    if constexpr (mode == Sweep::measure) {
      const double fx = static_cast<double>(force.x[0]), fy = static_cast<double>(force.y[0]);
      sums.numbers[StepSums::force_squared] += fx * fx + fy * fy;
    }
  });
}

/// The sums of all threads, for thread 0 alone.
template <class Run>
[[nodiscard]] KOKKOS_INLINE_FUNCTION SweepSums<SingleLane<double>> sums_of_all(const Run& run, const StepSums& own) {
  using D = SingleLane<double>;
  double all[StepSums::count] = {};
  reduce<Add>(run, own.numbers, all);
  run.block.barrier();
  double measure[1] = {own.largest_measure}, largest[1] = {};
  reduce<Largest>(run, measure, largest);
  return {D(all[StepSums::stress_xx]), D(all[StepSums::stress_xy]), D(all[StepSums::stress_yx]),
          D(all[StepSums::stress_yy]), D(all[StepSums::force_squared]), D(largest[0])};
}

}  // namespace voussoir::kernels::device
