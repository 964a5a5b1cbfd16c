#pragma once
/// Static tangent of all lanes at rest: the packing's own stiffness with the grains' motion condensed out.
///
/// Every contact is replaced by the springs of the law at its state (a contact that slides has lost its tangential
/// spring, one that rolls its rolling spring). Under a unit strain the grains move and spin until the springs balance:
/// K x = -B,  D = (1/V)(A - B^T K^+ B)  with A the springs' affine stiffness. Conjugate gradients (Hestenes and Stiefel
/// 1952) find x for the three unit strains at once, one RVE per lane. The preconditioner is symmetric Gauss-Seidel over
/// the blocks of the grains, in Eisenstat's form (SIAM J. Sci. Stat. Comput. 2, 1981): with K scaled to I + L + L^T
/// (grain_blocks.hpp) the iterations run for (I + L^T) x, whose matrix takes one substitution backward and one forward.
/// D is the energy of the motion found, sum k e_a e_b / V. It is therefore symmetric and positive semidefinite wherever
/// the iterations end, its error is of second order, and it is never softer than the exact D (Ritz).
///
/// K is singular (rigid translations, rattlers, mechanisms of sliding contacts), but the loads come from the same
/// springs, so the system is consistent and the iterations stay in the range of K.

#include <algorithm>
#include <array>
#include <limits>

#include "kernels/tangents/grain_blocks.hpp"

namespace voussoir::kernels {

inline constexpr double softest = 1e-2;  ///< energies are resolved down to this share of the affine energy, because
                                         ///< mechanisms have no energy

/// Answer of a group: sums over contacts, to be divided by the volume.
template <class V>
struct StaticTangent {
  V tangent[6] = {V(0), V(0), V(0), V(0), V(0), V(0)};  ///< as Homogenised::tangent [N m]
  PerStrain<V> affine;                                  ///< its diagonal for grains that do not move by themselves
  std::array<int, V::size()> iterations{};
  std::array<bool, V::size()> converged{};
};

template <class V>
KOKKOS_FORCEINLINE_FUNCTION V dot(const GrainDofs<V>& a, const GrainDofs<V>& b, const V& sum) {
  return fused(a.x, b.x, fused(a.y, b.y, fused(a.spin, b.spin, sum)));
}

/// a + b
template <class V>
KOKKOS_FORCEINLINE_FUNCTION GrainDofs<V> plus(const GrainDofs<V>& a, const GrainDofs<V>& b) {
  return {a.x + b.x, a.y + b.y, a.spin + b.spin};
}

/// a + s b
template <class V>
KOKKOS_FORCEINLINE_FUNCTION GrainDofs<V> plus(const GrainDofs<V>& a, const V& s, const GrainDofs<V>& b) {
  return {fused(s, b.x, a.x), fused(s, b.y, a.y), fused(s, b.spin, a.spin)};
}

/// The residual of (I + L^T) x: (I + L) takes it to the forces. Returns its squared norm by unit strain.
template <class V>
[[nodiscard]] PerStrain<V> begin_residuals(SpringSystem<V>& system) {
  PerStrain<V> norm{V(0), V(0), V(0)};
  const auto residual = [](SolverGrain<V>& g) -> StrainDofs<V>& { return g.residual; };
  substitute_forward(system, residual, residual, [&](const SolverGrain<V>&, const StrainDofs<V>& x) {
    for (std::size_t a = 0; a < unit_strains; ++a) norm[a] = dot(x[a], x[a], norm[a]);
  });
  return norm;
}

/// direction = residual + beta direction, and its image. The first directions are the residuals.
template <class V>
void turn_directions(SpringSystem<V>& system, bool first, const PerStrain<V>& beta) {
  if (first) {
    substitute_backward(system, [](SolverGrain<V>& g) -> const StrainDofs<V>& { return g.direction = g.residual; });
    return;
  }
  substitute_backward(system, [&](SolverGrain<V>& g) -> const StrainDofs<V>& {
    for (std::size_t a = 0; a < unit_strains; ++a) g.direction[a] = plus(g.residual[a], beta[a], g.direction[a]);
    return g.direction;
  });
}

/// The solutions that go on, lane by lane, and their energies.
template <class V>
struct Progress {
  PerStrain<V> running;
  PerStrain<V> energy;    ///< twice the energy of the motion so far: the diagonal of V D
  PerStrain<V> affine;    ///< the same of the affine motion
  PerStrain<V> rounding;  ///< squared residual below which a residual is rounding
  PerStrain<V> gained;    ///< its decrease in the last iteration
  PerStrain<V> before;    ///< its decrease in the iteration before
};

/// Completes the products of the matrix with the directions, image + answer, and returns the step lengths: rho /
/// (direction . product), 0 where a solution is frozen or its residual is down to rounding (at the exact solution of a
/// mechanism the next step would be the quotient of two rounding errors).
template <class V>
[[nodiscard]] PerStrain<V> step_lengths(SpringSystem<V>& system, const PerStrain<V>& rho, const Progress<V>& progress) {
  const V zero(0);
  PerStrain<V> work{zero, zero, zero}, alpha;
  substitute_forward(
      system,
      [](const SolverGrain<V>& g) {
        StrainDofs<V> rest;
        for (std::size_t a = 0; a < unit_strains; ++a) rest[a] = plus(g.direction[a], V(-1), g.image[a]);
        return rest;
      },
      [](SolverGrain<V>& g) -> StrainDofs<V>& { return g.answer; },
      [&](const SolverGrain<V>& g, const StrainDofs<V>& answer) {
        for (std::size_t a = 0; a < unit_strains; ++a) {
          work[a] = dot(g.direction[a], plus(g.image[a], answer[a]), work[a]);
        }
      });
  for (std::size_t a = 0; a < unit_strains; ++a) {
    const auto goes_on = (zero < work[a]) && (zero < progress.running[a]) && (progress.rounding[a] < rho[a]);
    alpha[a] = Kokkos::Experimental::condition(goes_on, rho[a] / work[a], zero);
  }
  return alpha;
}

/// Goes along the directions.
template <class V>
void advance_motions(SpringSystem<V>& system, const PerStrain<V>& alpha) {
  for (SolverGrain<V>& g : system.grains) {
    for (std::size_t a = 0; a < unit_strains; ++a) g.motion[a] = plus(g.motion[a], alpha[a], g.image[a]);
  }
}

/// Brings the residuals to the new motions. Returns their squared norms.
template <class V>
[[nodiscard]] PerStrain<V> reduce_residuals(SpringSystem<V>& system, const PerStrain<V>& alpha) {
  PerStrain<V> norm{V(0), V(0), V(0)};
  for (SolverGrain<V>& g : system.grains) {
    for (std::size_t a = 0; a < unit_strains; ++a) {
      g.residual[a] = plus(g.residual[a], -alpha[a], plus(g.image[a], g.answer[a]));
      norm[a] = dot(g.residual[a], g.residual[a], norm[a]);
    }
  }
  return norm;
}

/// The part of the energy that is still to be lost, if the losses go on as those of the last two iterations (the sum
/// of a geometric series); at least the last loss.
[[nodiscard]] KOKKOS_INLINE_FUNCTION double loss_to_come(double before, double last) {
  if (!(last > 0)) return last;  // NaN too
  return before > last ? last * Kokkos::max(1.0, last / (before - last)) : Kokkos::Experimental::infinity_v<double>;
}

/// Freezes the solutions whose diagonal entry is off by less than the square of the tolerance, as its last changes let
/// expect (what the energy loses in the last iterations estimates its error: Hestenes and Stiefel; Strakos and Tichy
/// 2002); false when no solution is left.
template <class V>
[[nodiscard]] bool look_at(Progress<V>& progress, StaticTangent<V>& out, int iteration, double tolerance) {
  bool any = false;
  for (std::size_t l = 0; l < V::size(); ++l) {
    bool lane_runs = false;
    for (std::size_t a = 0; a < unit_strains; ++a) {
      const double floor = softest * static_cast<double>(progress.affine[a][l]);
      const double energy = std::max(static_cast<double>(progress.energy[a][l]), floor);
      const double error = loss_to_come(static_cast<double>(progress.before[a][l]),
                                        static_cast<double>(progress.gained[a][l]));
      if (!(error > tolerance * tolerance * energy)) progress.running[a][l] = 0;  // NaN ends here too
      lane_runs = lane_runs || progress.running[a][l] > 0;
      progress.before[a][l] = progress.gained[a][l];
    }
    if (!lane_runs && !out.converged[l]) {
      out.converged[l] = true;
      out.iterations[l] = iteration;
    }
    any = any || lane_runs;
  }
  return any;
}

/// Runs the conjugate gradients, until the scaled motions are found.
template <class V>
void relax_springs(SpringSystem<V>& system, Progress<V>& progress, StaticTangent<V>& out,
                   const EngineSettings& settings) {
  const V zero(0);
  PerStrain<V> beta{zero, zero, zero};
  PerStrain<V> rho = begin_residuals(system);
  constexpr real_of<V> resolution = 8 * std::numeric_limits<real_of<V>>::epsilon();
  for (std::size_t a = 0; a < unit_strains; ++a) {
    progress.rounding[a] = V(resolution * resolution) * rho[a];
    progress.before[a] = V(std::numeric_limits<real_of<V>>::max());
  }
  for (int k = 1; k <= settings.tangent_iterations; ++k) {
    turn_directions(system, k == 1, beta);
    const PerStrain<V> alpha = step_lengths(system, rho, progress);
    advance_motions(system, alpha);
    for (std::size_t a = 0; a < unit_strains; ++a) {
      const V gain = alpha[a] * rho[a];
      progress.energy[a] = progress.energy[a] - gain;
      progress.gained[a] = gain;
    }
    if (!look_at(progress, out, k, settings.tangent_tolerance)) return;
    const PerStrain<V> next = reduce_residuals(system, alpha);
    for (std::size_t a = 0; a < unit_strains; ++a) {
      beta[a] = Kokkos::Experimental::condition((zero < alpha[a]) && (zero < rho[a]), next[a] / rho[a], zero);
    }
    rho = next;
  }
  for (std::size_t l = 0; l < V::size(); ++l) {
    if (!out.converged[l]) out.iterations[l] = settings.tangent_iterations;
  }
}

/// The static tangent of a group; to be called after homogenise(), which brings the contacts' histories to the final
/// positions. On return system.grains[i].motion holds the motion of grain i. @param live lanes whose answer is wanted;
/// the other lanes do not prolong the iterations
template <class Law, class V>
StaticTangent<V> static_tangent(const GroupState<Law>& group, SpringSystem<V>& system,
                                const std::array<bool, V::size()>& live, const EngineSettings& settings) {
  StaticTangent<V> out;
  Progress<V> progress;
  for (std::size_t a = 0; a < unit_strains; ++a) {
    progress.energy[a] = V(0);
    for (std::size_t l = 0; l < V::size(); ++l) progress.running[a][l] = live[l] ? real_of<V>(1) : real_of<V>(0);
  }
  collect_springs(group, settings.tangent, system);
  load_springs(system, settings.tangent == TangentKind::loading, progress.energy);
  out.affine = progress.affine = progress.energy;
  relax_springs(system, progress, out, settings);
  for (SolverGrain<V>& g : system.grains) {
    for (GrainDofs<V>& x : g.motion) x = unscaled(g.scale, x);
  }
  add_energies(system, out.tangent);
  return out;
}

}  // namespace voussoir::kernels
