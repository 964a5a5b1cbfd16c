#include "fem/relaxation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace voussoir::fem {

namespace {

/// Takes a further part of the increment over into the whole.
void append(Increment& whole, Increment&& part) {
  whole.displacement += part.displacement;
  for (std::size_t i = 0; i < whole.gradients.size(); ++i)
    whole.gradients[i] += part.gradients[i] + part.gradients[i] * whole.gradients[i];
  whole.stress = std::move(part.stress);
  whole.external_force = std::move(part.external_force);
  whole.reactions = std::move(part.reactions);
  whole.residual = std::move(part.residual);
  whole.points = std::move(part.points);
  whole.last_part = std::move(part.last_part);
}

/// Adds one more substep to the report of the whole increment.
void tally(NewtonReport& whole, NewtonReport&& part) {
  part.iterations += whole.iterations;
  part.evaluations += whole.evaluations;
  part.factorisations += whole.factorisations;
  part.work += whole.work;
  part.lane_steps += whole.lane_steps;
  part.times += whole.times;
  part.relaxations = whole.relaxations + 1;
  part.viscous_work += whole.viscous_work;
  part.material.deferral_error = std::max(part.material.deferral_error, whole.material.deferral_error);
  for (auto history : {&NewtonReport::residual_history, &NewtonReport::correction_history}) {
    (whole.*history).insert((whole.*history).end(), (part.*history).begin(), (part.*history).end());
    part.*history = std::move(whole.*history);
  }
  whole = std::move(part);
}

}  // namespace

void SubstepFactor::learn(double driving, double left, double residual) {
  if (needs_new_matrix()) {  // the last substep has made it
    if (in_vain_ >= options_.most_in_vain)
      options_.largest_factor = std::max(options_.least_cap, 0.5 * options_.largest_factor);
    value_ = std::min(1.0, options_.largest_factor);
    overshoots_ = in_vain_ = 0;
    return;
  }
  ++in_vain_;
  if (residual < 0.9 * least_residual_) {
    least_residual_ = residual;
    in_vain_ = 0;
  }
  const double spent = driving > 0 ? 1 - left / driving : 0;
  const double wanted = spent > 0 ? value_ / spent : options_.largest_factor;
  overshoots_ = wanted < options_.least_factor ? overshoots_ + 1 : 0;
  value_ = std::clamp(std::min(wanted, options_.factor_growth * value_), options_.least_factor,
                      options_.largest_factor);
}

NewtonReport relax(NewtonSolver& solver, MeshState& state, const LoadPath& path, double to, const NewtonReport& attempt,
                   Increment& increment, const RelaxationOptions& options) {
  const MeshState before = state;
  const std::shared_ptr<const HeldState> material_before = solver.material().hold();
  NewtonReport report = attempt;
  SubstepFactor factor(state.relaxation_factor, options);
  int settling = 0;
  solver.commit(state, increment);
  for (int substep = 0; substep < options.max_substeps; ++substep) {
    IncrementLoad load{path.external_force(to), path.prescribed_increment(to, to), 0, path.reference_force};
    load.first_step = factor.value() * solver.linear_solver().solve(increment.residual);
    load.moved = increment.displacement.norm();
    load.max_iterations = 1;
    load.keep_matrix = !factor.needs_new_matrix();
    load.settle = settling < options.max_settling;
    Increment part;
    NewtonReport answer = solver.solve_increment(state, load, part);
    const bool evaluated = answer.status == NewtonStatus::converged || answer.status == NewtonStatus::max_iterations;
    if (evaluated) {
      const double driving = increment.residual.dot(part.displacement);
      const double left = part.residual.dot(part.displacement);
      answer.viscous_work = 0.5 * (driving + left);
      factor.learn(driving, left, answer.residual);
    }
    const NewtonStatus status = answer.status;
    if (answer.residual <= answer.residual_bound) ++settling;
    tally(report, std::move(answer));
    if (!evaluated) break;
    solver.commit(state, part);
    append(increment, std::move(part));
    if (status != NewtonStatus::converged) continue;
    state.last_increment = increment.displacement;
    state.relaxation_factor = factor.value();
    return report;
  }
  state = before;
  solver.material().return_to(*material_before);
  return report;
}

}  // namespace voussoir::fem
