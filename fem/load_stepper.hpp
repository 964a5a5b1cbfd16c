#pragma once
/// Walks a load parameter (load factor, volume loss, ...) in increments; cuts and rolls back where one does not
/// converge.

#include <functional>
#include <string>
#include <vector>

#include "fem/newton.hpp"
#include "fem/relaxation.hpp"

namespace voussoir::fem {

/// The load as a function of the parameter, given by the stage.
struct LoadPath {
  std::function<Eigen::VectorXd(double parameter)> external_force;          ///< n_dofs [N/m]
  std::function<Constraints(double from, double to)> prescribed_increment;  ///< [m]; always the same dofs
  double reference_force = 0;                                               ///< as IncrementLoad::reference_force
};

struct StepOptions {
  double cut = 0.5;            ///< a failed step is tried again with this share
  double growth = 1.5;         ///< after a cut, each converged step lets the next one grow by this
  double smallest = 1.0 / 64;  ///< of the nominal step; below it the stepper gives up
  double relax_below = 0;      ///< of the nominal step: a step up to this that did not converge is relaxed, not cut
  RelaxationOptions relaxation = {};
  bool use_predictor = true;  ///< start from the last converged increment, scaled by the steps' ratio
};

enum class StepStatus {
  finished,  ///< the last target is reached
  stopped,   ///< a callback asked to stop; the state is that of the last converged increment
  gave_up    ///< a step below the smallest did not converge; the state is that of the last converged increment
};
[[nodiscard]] const char* to_string(StepStatus status);

/// A converged and committed increment.
struct ConvergedStep {
  double from;
  double to;
  bool target;  ///< `to` is one of the targets asked for, not a cut step on the way
  const NewtonReport& report;
  const Increment& increment;
  const MeshState& state;
};

struct FailedStep {
  double from;
  double to;
  const NewtonReport& report;
};

struct StepReport {
  StepStatus status = StepStatus::finished;
  int increments = 0;          ///< converged
  int cuts = 0;                ///< attempts that did not converge
  int relaxed = 0;             ///< increments that came to equilibrium by relaxation
  std::size_t work = 0;        ///< of all attempts
  std::size_t lane_steps = 0;  ///< likewise
  NewtonReport last;           ///< of the last attempt
  std::string message;         ///< why it gave up: status, parameter and step; empty otherwise
};

struct StepCallbacks {
  std::function<bool(const ConvergedStep&)> on_converged;  ///< false: stop after this increment; may be empty
  std::function<void(const FailedStep&)> on_failed;        ///< may be empty
};

/// Walks from state.parameter through the stage's `targets` (strictly increasing, the first beyond state.start); those
/// already reached are skipped. Nothing that did not converge is committed. A stage resumed from a copy of the state
/// and of the material's state, at any converged increment, with the same targets gives the same bits. Throws
/// std::invalid_argument on targets or options out of range.
[[nodiscard]] StepReport advance_load(NewtonSolver& solver, MeshState& state, const LoadPath& path,
                                      const std::vector<double>& targets, const StepOptions& options,
                                      const StepCallbacks& callbacks = {});

/// Load factors from 0 to 1 whose carried stress start + lambda grows by `ratio` from one to the next until the step
/// reaches `largest_step`, evenly after. Gravity: start = surcharge / (unit weight * height), ratio 1.5, largest_step
/// 0.05. Throws std::invalid_argument.
[[nodiscard]] std::vector<double> geometric_targets(double start, double ratio, double largest_step);

}  // namespace voussoir::fem
