#pragma once
/// The loading tangent of all lanes at rest. Column a is the change of stress under a small strain in direction a, over
/// the size of that strain. Each column has contacts of its own that stick and that reach their caps on the way.
///
/// The sign of the strain is that of the last motion, so that a column is the secant of a motion that goes on
/// (loading_step.hpp has the physics of the step). Newton's method finds the grains' motions. It starts from those of
/// the elastic tangent; the slopes of its residual are piecewise constant, because each round takes the contacts to be
/// at their caps that were so at the last residual. The linear systems are nonsymmetric, since f_t = +- mu f_n has no
/// potential. Stabilised biconjugate gradients (van der Vorst 1992) with the elastic diagonal as preconditioner reduce
/// the residual of each system to a tenth.
///
/// A packing may have no equilibrium within the step (a limit state), and contacts may alternate for ever between two
/// states. So a lane keeps its elastic tangent, and its report says so, where one of its columns has not converged at
/// the limit of iterations or its residual grows.

#include "kernels/tangents/loading_step.hpp"
#include "kernels/tangents/static_tangent.hpp"

namespace voussoir::kernels {

inline constexpr int most_rounds = 12;  ///< of Newton; steps that converge take 2 to 12
/// Most iterations for a column, if settings.tangent_iterations is not less. Of the columns that converge, 99 of 100
/// take fewer than 100 iterations (biaxial_bvp past its peak, strains of 1e-6 to 1e-4).
inline constexpr int most_step_iterations = 150;
inline constexpr double round_reduction = 0.1;  ///< factor on the residual by one round's linear solution

/// Answer of a group: sums over contacts, to be divided by the volume.
template <class V>
struct LoadingTangent {
  StressChange<V> change;  ///< by unit strain; the volume's change is not in it [N m]
  std::array<int, V::size()> iterations{};
  std::array<bool, V::size()> converged{};
};

/// The scalars of the biconjugate gradients. `running` is 1, or 0 where a column is frozen.
template <class V>
struct Biconjugate {
  PerStrain<V> running, rho, alpha, omega;
  PerStrain<V> target;  ///< squared preconditioned residual that ends a round
  PerStrain<V> count;   ///< iterations so far
};

template <class V>
[[nodiscard]] PerStrain<V> none_per_strain() {
  return {V(0), V(0), V(0)};
}

template <class V>
KOKKOS_FORCEINLINE_FUNCTION GrainDofs<V> scaled(const GrainDofs<V>& factor, const GrainDofs<V>& a) {
  return {factor.x * a.x, factor.y * a.y, factor.spin * a.spin};
}

/// residual . (preconditioner residual), by unit strain.
template <class V>
[[nodiscard]] PerStrain<V> preconditioned_norms(const SpringSystem<V>& system) {
  PerStrain<V> norm = none_per_strain<V>();
  for (const SolverGrain<V>& g : system.grains) {
    for (std::size_t a = 0; a < unit_strains; ++a) {
      norm[a] = dot(g.residual[a], scaled(g.inverse_diagonal, g.residual[a]), norm[a]);
    }
  }
  return norm;
}

/// x where the column is running and x is finite and not 0. Elsewhere the value is 0 and the column is frozen.
template <class V>
VOUSSOIR_LANES_INLINE V usable(const V& x, V& running) {
  const V zero(0), magnitude = Kokkos::abs(x);
  const auto fine = (zero < running) && (zero < magnitude) && (magnitude < V(std::numeric_limits<real_of<V>>::max()));
  running = Kokkos::Experimental::condition(fine, running, zero);
  return Kokkos::Experimental::condition(fine, x, zero);
}

/// Starts a round: the shadow is the preconditioned residual, and there is no direction yet.
template <class V>
void begin_round(SpringSystem<V>& system, StepSystem<V>& step, Biconjugate<V>& solver) {
  const V zero(0), one(1);
  const GrainDofs<V> none{zero, zero, zero};
  for (std::size_t i = 0; i < system.grains.size(); ++i) {
    SolverGrain<V>& g = system.grains[i];
    for (std::size_t a = 0; a < unit_strains; ++a) {
      step.grains[i].shadow[a] = scaled(g.inverse_diagonal, g.residual[a]);
      g.direction[a] = g.image[a] = none;
    }
  }
  solver.rho = solver.alpha = solver.omega = {one, one, one};
}

/// direction = preconditioned residual + beta (direction + omega preconditioned image); clears the images. An image
/// holds the forces of the contacts, so it is minus the matrix times the direction.
template <class V>
void turn_step_directions(SpringSystem<V>& system, StepSystem<V>& step, Biconjugate<V>& solver) {
  const V zero(0);
  PerStrain<V> rho = none_per_strain<V>(), beta;
  for (std::size_t i = 0; i < system.grains.size(); ++i) {
    for (std::size_t a = 0; a < unit_strains; ++a) {
      rho[a] = dot(step.grains[i].shadow[a], system.grains[i].residual[a], rho[a]);
    }
  }
  for (std::size_t a = 0; a < unit_strains; ++a) {
    rho[a] = usable(rho[a], solver.running[a]);
    const V ratio = rho[a] / solver.rho[a] * (solver.alpha[a] / solver.omega[a]);
    beta[a] = Kokkos::Experimental::condition(zero < solver.running[a], ratio, zero);
  }
  solver.rho = rho;
  for (SolverGrain<V>& g : system.grains) {
    for (std::size_t a = 0; a < unit_strains; ++a) {
      const V back = beta[a] * solver.omega[a];
      const GrainDofs<V> fresh = scaled(g.inverse_diagonal, plus(g.residual[a], back, g.image[a]));
      g.direction[a] = plus(fresh, beta[a], g.direction[a]);
      g.image[a] = {zero, zero, zero};
    }
  }
}

/// The first half of an iteration: it goes along the direction until the residual is orthogonal to the shadow.
template <class V>
void take_first_half(SpringSystem<V>& system, StepSystem<V>& step, Biconjugate<V>& solver) {
  const V zero(0);
  respond(
      system, [&](std::size_t i) -> const StrainDofs<V>& { return system.grains[i].direction; },
      [&](std::size_t i) -> StrainDofs<V>& { return system.grains[i].image; }, SlopesAct<V>{system, step});
  PerStrain<V> work = none_per_strain<V>();
  for (std::size_t i = 0; i < system.grains.size(); ++i) {
    for (std::size_t a = 0; a < unit_strains; ++a) {
      work[a] = dot(step.grains[i].shadow[a], system.grains[i].image[a], work[a]);
    }
  }
  for (std::size_t a = 0; a < unit_strains; ++a) {
    solver.alpha[a] = usable(-(solver.rho[a] / work[a]), solver.running[a]);
  }
  for (std::size_t i = 0; i < system.grains.size(); ++i) {
    SolverGrain<V>& g = system.grains[i];
    for (std::size_t a = 0; a < unit_strains; ++a) {
      g.residual[a] = plus(g.residual[a], solver.alpha[a], g.image[a]);
      step.grains[i].half[a] = scaled(g.inverse_diagonal, g.residual[a]);
      step.grains[i].half_image[a] = {zero, zero, zero};
    }
  }
}

/// The second half: it goes along the preconditioned residual until the residual is least, and moves the grains by both
/// halves.
template <class V>
void take_second_half(SpringSystem<V>& system, StepSystem<V>& step, Biconjugate<V>& solver) {
  respond(
      system, [&](std::size_t i) -> const StrainDofs<V>& { return step.grains[i].half; },
      [&](std::size_t i) -> StrainDofs<V>& { return step.grains[i].half_image; }, SlopesAct<V>{system, step});
  PerStrain<V> along = none_per_strain<V>(), squared = none_per_strain<V>();
  for (std::size_t i = 0; i < system.grains.size(); ++i) {
    for (std::size_t a = 0; a < unit_strains; ++a) {
      const GrainDofs<V>& image = step.grains[i].half_image[a];
      along[a] = dot(image, step.grains[i].half[a], along[a]);
      squared[a] = dot(image, scaled(system.grains[i].inverse_diagonal, image), squared[a]);
    }
  }
  for (std::size_t a = 0; a < unit_strains; ++a) {
    V also = solver.running[a];  // the gain of the first half is kept where the second half cannot be taken
    solver.omega[a] = usable(-(along[a] / squared[a]), also);
  }
  for (std::size_t i = 0; i < system.grains.size(); ++i) {
    SolverGrain<V>& g = system.grains[i];
    for (std::size_t a = 0; a < unit_strains; ++a) {
      g.motion[a] = plus(plus(g.motion[a], solver.alpha[a], g.direction[a]), solver.omega[a], step.grains[i].half[a]);
      g.residual[a] = plus(g.residual[a], solver.omega[a], step.grains[i].half_image[a]);
    }
  }
}

/// Freezes the columns that are reduced enough, out of iterations, or broken down. False when no column is left.
template <class V>
[[nodiscard]] bool goes_on(const SpringSystem<V>& system, Biconjugate<V>& solver, int limit) {
  const V zero(0), most(static_cast<real_of<V>>(limit));
  const PerStrain<V> norm = preconditioned_norms(system);
  bool any = false;
  for (std::size_t a = 0; a < unit_strains; ++a) {
    V& running = solver.running[a];
    solver.count[a] = solver.count[a] + running;
    running = Kokkos::Experimental::condition(
        (solver.target[a] < norm[a]) && (solver.count[a] < most) && (zero < Kokkos::abs(solver.omega[a])), running,
        zero);
    any = any || Kokkos::Experimental::any_of(zero < running);
  }
  return any;
}

/// Marks the columns of the lanes that another round may improve; `converged` marks those that need no other round.
template <class V>
[[nodiscard]] bool begin_columns(const SpringSystem<V>& system, const StaticTangent<V>& elastic,
                                 const PerStrain<V>& live, double tolerance, int limit, Biconjugate<V>& solver,
                                 LoadingTangent<V>& out) {
  using real = real_of<V>;
  const V zero(0), most(static_cast<real>(limit)), small(static_cast<real>(tolerance * tolerance));
  const PerStrain<V> norm = preconditioned_norms(system);
  bool any = false;
  out.converged.fill(true);
  for (std::size_t a = 0; a < unit_strains; ++a) {
    const V goal = small * elastic.affine[a];
    const auto done = !(goal < norm[a]) && (norm[a] < V(std::numeric_limits<real>::max()));  // false for NaN
    const auto open = (goal < norm[a]) && (norm[a] < elastic.affine[a]) && (solver.count[a] < most);
    solver.running[a] = Kokkos::Experimental::condition(open, live[a], zero);
    const V within = V(real(0.25)) * goal, reduced = V(static_cast<real>(round_reduction * round_reduction)) * norm[a];
    solver.target[a] = Kokkos::Experimental::condition(within < reduced, reduced, within);
    any = any || Kokkos::Experimental::any_of(zero < solver.running[a]);
    for (std::size_t l = 0; l < V::size(); ++l) {
      out.converged[l] = out.converged[l] && done[l];
    }
  }
  return any;
}

/// Signed sizes of the steps: in the sense of the last motion, positive where there was no motion.
template <class V, class Lanes>
[[nodiscard]] PerStrain<V> step_sizes(const Lanes& lanes, double strain) {
  PerStrain<V> size;
  for (std::size_t l = 0; l < V::size(); ++l) {
    const Mat2 last = lanes[l].drive.heading();
    const double heading[unit_strains] = {last.xx, last.yy, last.xy + last.yx};
    for (std::size_t a = 0; a < unit_strains; ++a) {
      size[a][l] = static_cast<real_of<V>>(heading[a] < 0 ? -strain : strain);
    }
  }
  return size;
}

/// The loading tangent of a group. @param elastic tangent of the same springs, whose motions are in `system`; @param
/// step has its sizes set
template <class Law, class V>
LoadingTangent<V> loading_tangent(const GroupState<Law>& group, SpringSystem<V>& system, StepSystem<V>& step,
                                  const StaticTangent<V>& elastic, const std::array<bool, V::size()>& live,
                                  const EngineSettings& settings) {
  const int limit = std::min(settings.tangent_iterations, most_step_iterations);
  LoadingTangent<V> out;
  Biconjugate<V> solver;
  solver.count = none_per_strain<V>();
  PerStrain<V> wanted;
  for (std::size_t a = 0; a < unit_strains; ++a) {
    for (std::size_t l = 0; l < V::size(); ++l) wanted[a][l] = live[l] ? real_of<V>(1) : real_of<V>(0);
  }
  prepare_step(group, system, step);
  for (int round = 0; round <= most_rounds; ++round) {
    take_step(group, system, step, out.change);
    if (!begin_columns(system, elastic, wanted, settings.tangent_tolerance, limit, solver, out) || round == most_rounds)
      break;
    begin_round(system, step, solver);
    do {
      turn_step_directions(system, step, solver);
      take_first_half(system, step, solver);
      take_second_half(system, step, solver);
    } while (goes_on(system, solver, limit));
  }
  for (std::size_t l = 0; l < V::size(); ++l) {
    for (std::size_t a = 0; a < unit_strains; ++a)
      out.iterations[l] = std::max(out.iterations[l], static_cast<int>(solver.count[a][l]));
  }
  return out;
}

}  // namespace voussoir::kernels
