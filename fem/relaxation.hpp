#pragma once
/// The way to the next equilibrium where Newton's iterates find none: grains that collapse within the increment make
/// the residual jump, and iterates that start anew from the committed state do not meet the same jump again. A
/// relaxation holds the load, commits the best iterate as it is, and lets the mesh move on under a viscous force. Every
/// substep is committed, so that grains which have collapsed stay collapsed. The state at the end must meet the same
/// criterion as that of any increment, without the viscous force.

#include <limits>
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
  double largest_factor = 3;  ///< the matrix of eq. (4) is too stiff by no more than this [-]
  /// Substeps in turn that overshoot even with the least factor, after which the matrix is made anew: grains that have
  /// touched again since the last one are stiffer than it says, so that the mesh would swing about them without end.
  int most_overshoots = 3;
  /// Substeps without a residual of 0.9 of the least so far, after which the matrix is made anew, too, and the largest
  /// factor is halved: a few stiff points overshoot with the factor that suits all others, and the mesh swings.
  int most_in_vain = 20;
  double least_cap = 0.5;      ///< the largest factor is not halved below this [-]
  double factor_growth = 1.5;  ///< largest growth of the factor per substep: softening ground would let it grow on [-]
};

/// The factor on K^-1 R of the next substep of a relaxation, and whether K serves for it.
class SubstepFactor {
 public:
  SubstepFactor(double first, const RelaxationOptions& options) : value_(first), options_(options) {}

  [[nodiscard]] double value() const { return value_; }
  /// Whether the next substep has to make a new matrix: the last ones have overshot although they had the
  /// least factor, or have brought the residual no further.
  [[nodiscard]] bool needs_new_matrix() const {
    return overshoots_ >= options_.most_overshoots || in_vain_ >= options_.most_in_vain;
  }

  /// Takes the factor with which a linear response to the last substep would have left no work; behind a new matrix it
  /// is 1, or the largest one where that is less. `driving` and `left` are the work along the substep of R at its start
  /// and of R at its end [J/m], `residual` is |R| at its end [N/m].
  void learn(double driving, double left, double residual);

 private:
  double value_;
  RelaxationOptions options_;
  int overshoots_ = 0;  ///< substeps in turn that wanted less than the least factor
  int in_vain_ = 0;     ///< substeps since the residual has last fallen below the least one
  double least_residual_ = std::numeric_limits<double>::infinity();  ///< [N/m]
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
