#pragma once
/// The static tangent of a block's RVE at rest: the tangent of tangents/static_tangent.hpp, found by conjugate
/// gradients whose preconditioner is the block of each grain. The lanes' preconditioner (Gauss-Seidel) goes from grain
/// to grain, which the threads of a block cannot do side by side.
///
/// The unit strains follow one another, because the directions of three would not fit the fast memory. Both engines end
/// the iterations by the same estimate, so that their tangents differ by the tolerance.

#include "kernels/device/block_finish.hpp"
#include "kernels/tangents/found_tangent.hpp"
#include "kernels/tangents/static_tangent.hpp"

namespace voussoir::kernels::device {

/// The work of the iterations, told by thread 0 to all.
struct Iteration {
  double rho = 0;       ///< squared residual
  double energy = 0;    ///< twice the energy of the motion so far
  double affine = 0;    ///< the same of the affine motion
  double gained = 0;    ///< what the energy has lost in the last iteration
  double before = 0;    ///< what it lost in the iteration before
  double rounding = 0;  ///< squared residual below which a residual is rounding
};

/// Writes the springs of all touching pairs into the device's memory.
template <class Run>
KOKKOS_FORCEINLINE_FUNCTION void write_springs(Run& run, const CellMotion<typename Run::V>& cell) {
  using V = typename Run::V;
  using real = typename Run::real;
  const V share(static_cast<real>(elastic_share(run.settings.tangent)));
  each_pair(run, [&](int p) {
    const int i = first_of(run.at.keys[p]), j = second_of(run.at.keys[p]);
    const auto shape = shape_of(run, i, j, run.at.rim[i].y, run.at.rim[j].y);
    const PairGeometry<V> at = geometry_of_pair(run, p, cell);
    run.at.springs[p] = spring_of(pair_of(run, p), shape, at, distance_of(at.gap, shape), share);
  });
  run.block.barrier();
}

/// Calls pull(spring, radius_i, radius_j, i, j, on_i, on_j) for all pairs and leaves the action on both grains in fast
/// memory.
template <class Run, class Act>
KOKKOS_FORCEINLINE_FUNCTION void press_springs(Run& run, const Act& act) {
  using V = typename Run::V;
  const V zero(0);
  each_pair(run, [&](int p) {
    const int i = first_of(run.at.keys[p]), j = second_of(run.at.keys[p]);
    const SpringLanes<V>& s = run.at.springs[p];
    GrainDofs<V> on_i{zero, zero, zero}, on_j{zero, zero, zero};
    act(s, V(run.at.rim[i].y), V(run.at.rim[j].y), i, j, on_i, on_j);
    run.at.action[p] = {on_i.x[0], on_i.y[0], on_i.spin[0], on_j.spin[0]};
  });
  run.block.barrier();
}

/// The block of a grain in K.
template <class Run>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION Triangle<typename Run::V> block_of(const Run& run, int i) {
  using V = typename Run::V;
  const V zero(0), radius(run.at.rim[i].y);
  Triangle<V> block{zero, zero, zero, zero, zero, zero};
  each_pair_of(run, i,
               [&](int p, bool is_second) { add_block(run.at.springs[p], is_second ? -radius : radius, block); });
  return block;
}

/// Sum of a number over all threads, for all of them.
template <class Run>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION double total(const Run& run, double own) {
  double numbers[1] = {own};
  reduce_for_all<Add>(run, numbers);
  return numbers[0];
}

template <class V>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION double squared(const GrainDofs<V>& a) {
  return static_cast<double>(dot(a, a, V(0))[0]);
}

/// The forces of the springs on grains that follow unit strain `a` as residuals. Returns twice the energy.
template <class Run, class Slot>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION Iteration load_strain(Run& run, Slot& slot, int a) {
  using V = typename Run::V;
  const V zero(0);
  double energy = 0, norm = 0;
  press_springs(run, [&](const SpringLanes<V>& s, const V& ri, const V& rj, int, int, auto& on_i, auto& on_j) {
    V dx = zero, dy = zero;
    add_unit_strain(a, s, dx, dy);
    const SpringStrain<V> e = spring_strain(s, dx, dy, ri, zero, rj, zero);
    pull(s, force_of(s, e), ri, rj, on_i, on_j);
    energy += static_cast<double>(fused(s.normal * e.normal, e.normal, s.tangential * e.sliding * e.sliding)[0]);
  });
  each_held(run, slot, run.grains, [&](int k, int i) {
    auto& own = slot[k];
    own.residual = own.direction = scaled(own.scale, gather(run, i));
    own.motion = {zero, zero, zero};
    norm += squared(own.residual);
  });
  run.block.barrier();
  Iteration out;
  out.energy = out.affine = total(run, energy);
  out.rho = total(run, norm);
  constexpr double resolution = 8 * Kokkos::Experimental::epsilon_v<typename Run::real>;
  out.rounding = resolution * resolution * out.rho;
  out.before = Kokkos::Experimental::finite_max_v<double>;
  return out;
}

/// One step along the directions. False where the residual is down to rounding.
template <class Run, class Slot>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION bool iterate(Run& run, Slot& slot, Iteration& now) {
  using V = typename Run::V;
  using real = typename Run::real;
  each_held(run, slot, run.grains, [&](int k, int i) {
    const GrainDofs<V> d = unscaled(slot[k].scale, slot[k].direction);
    run.at.motion[i] = {d.x[0], d.y[0], d.spin[0], 0};
  });
  run.block.barrier();
  press_springs(run, [&](const SpringLanes<V>& s, const V& ri, const V& rj, int i, int j, auto& on_i, auto& on_j) {
    const Four<real> from = run.at.motion[i], to = run.at.motion[j];
    const auto e = spring_strain(s, V(to.x - from.x), V(to.y - from.y), ri, V(from.z), rj, V(to.z));
    pull(s, force_of(s, e), ri, rj, on_i, on_j);
  });
  double work = 0, norm = 0;
  each_held(run, slot, run.grains, [&](int k, int i) {
    slot[k].image = scaled(slot[k].scale, gather(run, i));
    work -= static_cast<double>(dot(slot[k].direction, slot[k].image, V(0))[0]);
  });
  run.block.barrier();
  const double product = total(run, work);
  if (!(product > 0) || !(now.rho > now.rounding)) return false;
  const double alpha = now.rho / product;
  each_held(run, slot, run.grains, [&](int k, int) {
    auto& own = slot[k];
    own.motion = plus(own.motion, V(static_cast<real>(alpha)), own.direction);
    own.residual = plus(own.residual, V(static_cast<real>(alpha)), own.image);
    norm += squared(own.residual);
  });
  const double next = total(run, norm);
  now.energy -= alpha * now.rho;
  now.gained = alpha * now.rho;
  const V beta(static_cast<real>(next / now.rho));
  each_held(run, slot, run.grains,
            [&](int k, int) { slot[k].direction = plus(slot[k].residual, beta, slot[k].direction); });
  now.rho = next;
  return true;
}

/// Whether the energy still changes by more than the tolerance allows.
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION bool goes_on(Iteration& now, double tolerance) {
  const double floor = softest * now.affine;
  const double energy = now.energy > floor ? now.energy : floor;
  const double error = loss_to_come(now.before, now.gained);
  now.before = now.gained;
  return error > tolerance * tolerance * energy;
}

/// Solves for one unit strain. Returns the iterations, negative where their limit was reached.
template <class Run, class Slot>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION int solve(Run& run, Slot& slot, int a) {
  Iteration now = load_strain(run, slot, a);
  int k = 0;
  bool running = true;
  while (running && k < run.settings.tangent_iterations) {
    ++k;
    running = iterate(run, slot, now) && goes_on(now, run.settings.tangent_tolerance);
  }
  each_held(run, slot, run.grains, [&](int s, int i) {
    const auto x = unscaled(slot[s].scale, slot[s].motion);
    run.at.answers[a * run.grains + i] = {x.x[0], x.y[0], x.spin[0]};
  });
  run.block.barrier();
  return running ? -k : k;
}

/// Twice the mixed energies of the three motions, which thread 0 alone receives.
template <class Run>
KOKKOS_FORCEINLINE_FUNCTION void energies(Run& run, double (&all)[6]) {
  using V = typename Run::V;
  double own[6] = {};
  each_pair(run, [&](int p) {
    const int i = first_of(run.at.keys[p]), j = second_of(run.at.keys[p]);
    const SpringLanes<V>& s = run.at.springs[p];
    SpringStrain<V> e[unit_strains];
    for (int a = 0; a < unit_strains; ++a) {
      const auto& from = run.at.answers[a * run.grains + i];
      const auto& to = run.at.answers[a * run.grains + j];
      V dx(to.x - from.x), dy(to.y - from.y);
      add_unit_strain(a, s, dx, dy);
      e[a] = spring_strain(s, dx, dy, V(run.at.rim[i].y), V(from.spin), V(run.at.rim[j].y), V(to.spin));
    }
    V one[6] = {V(0), V(0), V(0), V(0), V(0), V(0)};
    add_mixed_energies(s, e, one);
    for (int c = 0; c < 6; ++c) own[c] += static_cast<double>(one[c][0]);
  });
  run.block.barrier();
  reduce<Add>(run, own, all);
}

/// Puts the static tangent in place of eq. (4) in the report, where it is usable. The motions of grains are
/// overwritten.
template <class Run>
VOUSSOIR_COLD_FUNCTION void find_tangent(const typename Run::Seat seat, const double volume) {
  Run run(seat);
  const CellMotion<typename Run::V> cell = run.at.control->motion[0];
  using V = typename Run::V;
  write_springs(run, cell);
  Slots<SolverSlot<V>, Run::Plan::grain_slots> slot(run.at.solver, run.grains, run.block.thread(), run.block.threads());
  each_held(run, slot, run.grains, [&](int k, int i) { slot[k].scale = scale_of(block_of(run, i)); });
  int iterations = 0;
  bool capped = false;
  for (int a = 0; a < unit_strains; ++a) {
    const int took = solve(run, slot, a);
    capped = capped || took < 0;
    iterations = std::abs(took) > iterations ? std::abs(took) : iterations;
  }
  FoundTangent found{run.settings.tangent, {}, {}, iterations, !capped};
  energies(run, found.tangent);
  alone(run, [&] {
    RveReport& report = run.batch.reports[run.number];
    for (double& entry : found.tangent) entry /= volume;
    report.tangent_iterations = found.iterations;
    report.tangent_capped = !found.converged;
    double contact[6];
    for (int c = 0; c < 6; ++c) contact[c] = report.tangent[c];
    replace_tangent(report, found, contact);
  });
}

}  // namespace voussoir::kernels::device
