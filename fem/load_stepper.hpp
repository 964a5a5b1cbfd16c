#pragma once
/// Walks a load parameter (load factor, volume loss, ...) in increments. An increment that does not converge is rolled
/// back and tried again with a smaller step.

#include <functional>
#include <string>
#include <vector>

#include "fem/load_path.hpp"
#include "fem/newton.hpp"
#include "fem/relaxation.hpp"

namespace voussoir::fem {

struct StepOptions {
  double cut = 0.5;     ///< a step that failed is tried again with this share of its length [-]
  double growth = 1.5;  ///< after a cut, a step that converged lets the next one be longer by this factor [-]
  /// Smallest step that is tried, over the distance between the targets around it; the stepper gives up below it [-].
  double smallest = 1.0 / 64;
  /// Largest step that is relaxed where it does not converge, over the same distance; a longer one is cut [-].
  double relax_below = 0;
  RelaxationOptions relaxation = {};
  bool use_predictor = true;  ///< iterates start from the last converged increment, scaled by the ratio of the steps
};

enum class StepStatus {
  finished,  ///< the last target has been reached
  stopped,   ///< a callback asked to stop; the state is that of the last converged increment
  gave_up    ///< a step below the smallest did not converge; the state is that of the last converged increment
};
[[nodiscard]] const char* to_string(StepStatus status);

/// A converged and committed increment.
struct ConvergedStep {
  double from;
  double to;
  bool target;  ///< `to` is one of the targets; false for a shorter step on the way to one
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
  int increments = 0;    ///< increments that converged
  int cuts = 0;          ///< attempts that did not converge
  int relaxed = 0;       ///< increments that came to equilibrium by relaxation
  std::size_t work = 0;  ///< particle-steps of all attempts
  NewtonReport last;     ///< the report of the last attempt
  std::string message;   ///< status, parameter and step where the stepper gave up; empty otherwise
};

struct StepCallbacks {
  std::function<bool(const ConvergedStep&)> on_converged;  ///< returns false to stop after this increment; may be empty
  std::function<void(const FailedStep&)> on_failed;        ///< may be empty
};

/// Walks from state.parameter through the stage's `targets`, which increase strictly from state.start on; targets that
/// the state has reached already are skipped. An increment that did not converge is never committed. A stage resumed
/// from a copy of the state and of the material's state, at any converged increment, with the same targets gives the
/// same bits. Throws std::invalid_argument on targets or options out of range.
[[nodiscard]] StepReport advance_load(NewtonSolver& solver, MeshState& state, const LoadPath& path,
                                      const std::vector<double>& targets, const StepOptions& options,
                                      const StepCallbacks& callbacks = {});

/// Load factors from 0 to 1 whose carried stress start + lambda grows by `ratio` from one to the next until the step
/// reaches `largest_step`, and evenly after that. Gravity takes start = surcharge / (unit weight * height), ratio 1.5,
/// largest_step 0.05. Throws std::invalid_argument.
[[nodiscard]] std::vector<double> geometric_targets(double start, double ratio, double largest_step);

}  // namespace voussoir::fem
