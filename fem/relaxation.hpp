#pragma once
/// The way to the next equilibrium where Newton's iterates find none: grains that collapse within the increment make
/// the residual jump, and iterates that start anew from the committed state do not meet the same jump again. A
/// relaxation holds the load, commits the best iterate as it is, and lets the mesh move on under a viscous force. Every
/// substep is committed, so that grains which have collapsed stay collapsed. The state at the end must meet the same
/// criterion as that of any increment, without the viscous force.

#include <vector>

#include "fem/load_path.hpp"
#include "fem/newton.hpp"

namespace voussoir::fem {

struct RelaxationOptions {
  int max_substeps = 100;  ///< most substeps of one relaxation; with 0 increments are never relaxed
  int max_attempts = 3;    ///< Newton's iterates from the committed state that precede a relaxation
  int max_settling = 30;   ///< substeps at equilibrium that let grains at their step limit come to rest
  /// Residual, over the reference of the tolerance, below which Newton's iterates end at once and the increment is
  /// relaxed [-].
  double near_residual = 0.4;
  double far_residual = 0.5;  ///< residual, over the same reference, above which an increment is cut, not relaxed [-]
  /// Bounds of the factor on K^-1 R, which is the substep's time over the viscous time. The first substep takes the
  /// factor with which the relaxation before it ended, or 1 at the start of a stage [-].
  double least_factor = 0.25;
  double largest_factor = 3;   ///< the matrix of eq. (4) is too stiff by no more than this [-]
  double factor_growth = 1.5;  ///< largest growth of the factor per substep: softening ground would let it grow on [-]
};

/// Relaxes an increment to the parameter `to` that Newton's iterates could not bring to equilibrium. `attempt` is their
/// report, and `increment` their best iterate, at which the material was evaluated last. The viscous force is
/// K du / factor, with K the matrix of the solver's iterates; a substep is one semi-implicit step du = factor K^-1 R.
/// The factor follows the work of the residual, so that the substeps neither creep nor overshoot. Where the relaxation
/// converges, state and material are at the new equilibrium and `increment` holds the whole way. Otherwise state and
/// material are as before the call.
[[nodiscard]] NewtonReport relax(NewtonSolver& solver, MeshState& state, const LoadPath& path, double to,
                                 const NewtonReport& attempt, Increment& increment, const RelaxationOptions& options);

}  // namespace voussoir::fem
