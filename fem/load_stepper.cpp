#include "fem/load_stepper.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace voussoir::fem {

namespace {

void require(bool holds, const char* sentence) {
  if (!holds) throw std::invalid_argument(std::string("load stepper: ") + sentence);
}

void check(const MeshState& state, const LoadPath& path, const std::vector<double>& targets, const StepOptions& o) {
  require(static_cast<bool>(path.external_force) && static_cast<bool>(path.prescribed_increment),
          "the load path lacks a function");
  require(o.cut > 0 && o.cut < 1, "cut must be between 0 and 1");
  require(o.growth >= 1, "growth must be at least 1");
  require(o.smallest > 0 && o.smallest <= 1, "smallest must be in (0, 1]");
  double previous = state.start;
  for (const double target : targets) {
    require(std::isfinite(target) && target > previous,
            "the targets must be finite and increase from the stage's start");
    previous = target;
  }
}

/// The end of the next attempt: the target, or the largest step away if that is nearer. Where less than a quarter of a
/// step would be left after that, the rest of the way is halved, because a very short step would spoil the predictor of
/// the next one.
double attempt_end(const MeshState& state, double target) {
  const double rest = target - state.parameter;
  if (state.step_limit == 0 || rest <= state.step_limit) return target;
  return state.parameter + (rest < 1.25 * state.step_limit ? 0.5 * rest : state.step_limit);
}

IncrementLoad load_between(const LoadPath& path, const MeshState& state, double to, bool use_predictor) {
  constexpr double largest_ratio = 2;  // beyond it, extrapolation is worse than the elastic start
  IncrementLoad load{path.external_force(to), path.prescribed_increment(state.parameter, to), 0, path.reference_force};
  if (use_predictor && state.last_step > 0) {
    const double ratio = (to - state.parameter) / state.last_step;
    if (ratio <= largest_ratio) load.predictor_ratio = ratio;
  }
  return load;
}

std::string describe(const NewtonReport& newton, double from, double to) {
  std::ostringstream text;
  text.precision(10);
  text << to_string(newton.status) << " in the increment from " << from << " to " << to << " (residual "
       << newton.residual << " N/m, allowed " << newton.residual_bound << " N/m, the largest part at (";
  text.precision(4);
  text << newton.worst_place.x() << ", " << newton.worst_place.y() << ") m, " << newton.iterations << " iterations";
  if (newton.relaxations > 0)
    text << ", " << newton.relaxations << " of them substeps of a relaxation that found no equilibrium";
  text << ")";
  if (!newton.material.message.empty()) text << ": " << newton.material.message;
  return text.str();
}

/// Whether an attempt has an iterate from which a relaxation can start.
bool can_be_relaxed(const NewtonReport& attempt, double far_residual) {
  const bool usable = attempt.material.usable && attempt.residual <= far_residual * attempt.reference();
  return usable && (attempt.status == NewtonStatus::max_iterations || attempt.status == NewtonStatus::near);
}

/// Walks to one target; `nominal` is the distance from the target before it. Returns true where the target was reached.
bool walk_to(double target, double nominal, NewtonSolver& solver, MeshState& state, const LoadPath& path,
             const StepOptions& options, const StepCallbacks& callbacks, StepReport& report) {
  while (state.parameter < target) {
    const double from = state.parameter;
    const double to = attempt_end(state, target);
    IncrementLoad load = load_between(path, state, to, options.use_predictor);
    const bool may_relax = options.relaxation.max_substeps > 0 &&
                           to - from <= options.relax_below * nominal * (1 + 1e-9);
    if (may_relax) {
      load.leave_best = true;
      load.settle = true;
      load.max_iterations = options.relaxation.max_attempts;
      load.near_residual = options.relaxation.near_residual;
    }
    Increment increment;
    report.last = solver.solve_increment(state, load, increment);
    const bool relaxed = may_relax && can_be_relaxed(report.last, options.relaxation.far_residual);
    if (relaxed) report.last = relax(solver, state, path, to, report.last, increment, options.relaxation);
    report.work += report.last.work;
    if (report.last.status != NewtonStatus::converged) {
      ++report.cuts;
      if (callbacks.on_failed) callbacks.on_failed({from, to, report.last});
      const double next = (to - from) * options.cut;
      const bool shorter = from + next > from && from + next < to;  // false where rounding leaves no step or the same
      if (next < options.smallest * nominal || !shorter) {
        report.status = StepStatus::gave_up;
        report.message = describe(report.last, from, to);
        return false;
      }
      state.step_limit = next;
      continue;
    }
    if (relaxed) ++report.relaxed;
    if (!relaxed) solver.commit(state, increment);  // a relaxation has committed
    ++report.increments;
    state.parameter = to;
    state.last_step = to - from;
    state.step_limit *= options.growth;
    if (state.step_limit >= nominal) state.step_limit = 0;
    if (callbacks.on_converged && !callbacks.on_converged({from, to, to == target, report.last, increment, state})) {
      report.status = StepStatus::stopped;
      return false;
    }
  }
  return true;
}

}  // namespace

StepReport advance_load(NewtonSolver& solver, MeshState& state, const LoadPath& path,
                        const std::vector<double>& targets, const StepOptions& options,
                        const StepCallbacks& callbacks) {
  check(state, path, targets, options);
  StepReport report;
  double previous = state.start;
  for (const double target : targets) {
    if (!walk_to(target, target - previous, solver, state, path, options, callbacks, report)) break;
    previous = target;
  }
  return report;
}

std::vector<double> geometric_targets(double start, double ratio, double largest_step) {
  require(start > 0 && std::isfinite(start), "geometric targets: start must be positive");
  require(ratio > 1 && std::isfinite(ratio), "geometric targets: ratio must be above 1");
  require(largest_step > 1e-6 && largest_step <= 1, "geometric targets: largest_step must be in (1e-6, 1]");
  std::vector<double> targets;
  double reached = 0;
  for (double carried = start * ratio; carried - start < 1 && carried - start - reached < largest_step;
       carried *= ratio)
    targets.push_back(reached = carried - start);
  const int uniform = std::max(1, static_cast<int>(std::ceil((1 - reached) / largest_step - 1e-9)));
  for (int k = 1; k <= uniform; ++k) targets.push_back(k == uniform ? 1.0 : reached + (1 - reached) * k / uniform);
  return targets;
}

const char* to_string(StepStatus status) {
  switch (status) {
    case StepStatus::finished:
      return "finished";
    case StepStatus::stopped:
      return "stopped";
    case StepStatus::gave_up:
      return "gave_up";
  }
  return "unknown";
}

}  // namespace voussoir::fem
