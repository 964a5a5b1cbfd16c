#pragma once
/// The way from one equilibrium to the next where an increment has none near by: grains that collapse within it make
/// the residual jump, and no iterate that starts anew from the committed state meets the jump again. The load is held,
/// the best iterate is committed as it is, and the mesh moves on under a viscous force, every substep committed: what
/// has collapsed stays collapsed. The end is held to the same criterion as any increment, without the viscous force.

#include <vector>

#include "fem/load_path.hpp"
#include "fem/newton.hpp"

namespace voussoir::fem {

struct RelaxationOptions {
  int max_substeps = 100;      ///< 0: increments are never relaxed
  int max_attempts = 3;        ///< iterates that start anew from the committed state before
  int max_settling = 3;        ///< substeps at equilibrium for grains at their step limit to come to rest
  double near_residual = 0.4;  ///< residual over the reference of the tolerance below which they end at once [-]
  double far_residual = 0.5;   ///< residual from which no increment is relaxed: it is cut [-]
  double least_factor = 0.25;  ///< on K^-1 R: the substep's time over the viscous time; the first substep has the last
                               ///< one's of the relaxation before, 1 at a stage's start
  double largest_factor = 3;   ///< eq. (4) is no more than that too stiff
  double factor_growth = 1.5;  ///< from one substep to the next: where the ground softens the work never falls
};

/// Relaxes an increment to the parameter `to` that `attempt` (its last report) could not bring to equilibrium;
/// `increment` is its best iterate, the material's last evaluation. The viscous force is K du / factor with K the
/// matrix of `solver`'s iterates, one semi-implicit step each: du = factor K^-1 R. The factor follows the work of the
/// residual, so that the substeps neither creep nor overshoot. Converged: state and material are at the new
/// equilibrium, `increment` holds the whole way. Otherwise both are as before the call.
[[nodiscard]] NewtonReport relax(NewtonSolver& solver, MeshState& state, const LoadPath& path, double to,
                                 const NewtonReport& attempt, Increment& increment, const RelaxationOptions& options);

}  // namespace voussoir::fem
