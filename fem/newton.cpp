#include "fem/newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <optional>
#include <stdexcept>

#include "fem/anderson.hpp"
#include "fem/noise.hpp"

namespace voussoir::fem {

namespace {

using Failure = std::optional<NewtonStatus>;  ///< empty where nothing has failed

void check(const NewtonOptions& o) {
  const auto require = [](bool holds, const char* sentence) {
    if (!holds) throw std::invalid_argument(std::string("newton: ") + sentence);
  };
  require(o.tolerance > 0 && o.displacement_tolerance > 0, "the tolerances must be positive");
  require(o.length_tolerance >= 0, "the length tolerance must not be negative");
  require(o.max_iterations >= 1 && o.refactor_every >= 1, "max_iterations and refactor_every must be at least 1");
  require(o.initial_tangent_share >= 0, "the initial tangent's share must not be negative");
  require(o.anderson_depth >= 0 && o.anderson_condition > 1, "Anderson's depth must be >= 0, its condition > 1");
  require(o.noise_factor >= 0, "noise_factor must not be negative");
  require(o.growth_limit > 1 && o.max_halvings >= 0, "growth_limit must be > 1, max_halvings >= 0");
}

}  // namespace

/// One call of solve_increment: its iterate, its residual and its report.
struct NewtonSolver::Workspace {
  Workspace(NewtonSolver& owner, const MeshState& from, const IncrementLoad& asked, Increment& result)
      : solver(owner),
        state(from),
        load(asked),
        increment(result),
        history(owner.options_.anderson_depth, owner.options_.anderson_condition) {}

  NewtonSolver& solver;
  const MeshState& state;
  const IncrementLoad& load;
  Increment& increment;
  NewtonReport report;
  std::vector<char> constrained;
  std::vector<Gradient> displacement_gradient;
  Eigen::VectorXd noise_sample;
  AndersonHistory history;
  Eigen::VectorXd step;
  double best_residual = std::numeric_limits<double>::infinity();
  Eigen::VectorXd best;  ///< displacement of the iterate with the smallest residual

  struct Trial {
    Increment increment;
    NewtonReport report;
  };
  void restore(Trial&& trial);

  Failure prepare();
  Failure predict();
  Failure take_step();
  [[nodiscard]] std::vector<double> stiffness(double share);
  [[nodiscard]] bool renews_matrix() const;
  Failure refactor();
  Failure find_step();
  Failure evaluate();
  void form_residual();
  [[nodiscard]] bool converged() const;
  [[nodiscard]] bool near() const;
  void return_to_best();
  NewtonReport stop(NewtonStatus status);
};

NewtonReport NewtonSolver::solve_increment(const MeshState& state, const IncrementLoad& load, Increment& increment) {
  Workspace work(*this, state, load, increment);
  if (const Failure failure = work.prepare()) return work.stop(*failure);  // geometry, constraints
  material_.begin_increment();
  if (const Failure failure = work.predict()) return work.stop(*failure);  // first step
  for (int iteration = 1;; ++iteration) {
    work.report.iterations = iteration;
    if (const Failure failure = work.take_step()) return work.stop(*failure);  // gradients, material, residual
    if (work.renews_matrix())
      if (const Failure failure = work.refactor()) return work.stop(*failure);  // assemble, factorise
    if (const Failure failure = work.find_step()) return work.stop(*failure);   // solve, accelerate
    if (on_iterate) on_iterate({iteration, work.report.residual, work.report.residual_bound, work.report.material});
    if (work.converged()) return work.stop(NewtonStatus::converged);
    if (work.near()) return work.stop(NewtonStatus::near);
    if (iteration == (load.max_iterations > 0 ? load.max_iterations : options_.max_iterations))
      return work.stop(NewtonStatus::max_iterations);
  }
}

Failure NewtonSolver::Workspace::prepare() {
  const Mesh& mesh = solver.mesh_;
  if (load.external_force.size() != mesh.n_dofs())
    throw std::invalid_argument("newton: the external force has the wrong size");
  constrained.assign(mesh.n_dofs(), 0);
  for (const auto& [dof, value] : load.prescribed) {
    if (dof < 0 || dof >= mesh.n_dofs()) throw std::invalid_argument("newton: a constraint is on no degree of freedom");
    constrained[dof] = 1;
  }
  increment.stress.resize(mesh.n_points());
  if (!load.keep_matrix) increment.tangent.resize(mesh.n_points());
  increment.gradients.resize(mesh.n_points());
  increment.external_force = load.external_force;
  increment.displacement = Eigen::VectorXd::Zero(mesh.n_dofs());
  increment.points = gauss_points(mesh, state.coordinates);
  if (!(increment.points.smallest_jacobian > 0)) return NewtonStatus::inverted_element;
  noise_sample = unit_noise_sample(mesh, increment.points, constrained);
  return {};
}

/// Finds the first step: the last increment, scaled, or with ratio 0 the elastic answer to the load that is not carried
/// yet. Where constrained dofs then differ from their prescribed values, the elastic answer to the difference is added,
/// so that no element takes the motion of the boundary alone.
Failure NewtonSolver::Workspace::predict() {
  const Mesh& mesh = solver.mesh_;
  if (load.first_step.size() > 0) {
    step = load.first_step;
    for (const auto& [dof, value] : load.prescribed) step[dof] = value;
    return step.allFinite() ? Failure{} : Failure{NewtonStatus::not_finite};
  }
  solver.material_.committed(increment.stress, {});
  increment.tangent = state.tangent;
  if (const Failure failure = refactor()) return failure;
  const Eigen::VectorXd guess = load.predictor_ratio * state.last_increment;
  Eigen::VectorXd lift = Eigen::VectorXd::Zero(mesh.n_dofs());
  for (const auto& [dof, value] : load.prescribed) lift[dof] = value - guess[dof];
  displacement_gradients(mesh, increment.points, lift, displacement_gradient);
  std::vector<Stress> stress(mesh.n_points());
  for (int i = 0; i < mesh.n_points(); ++i) {
    stress[i] = (increment.tangent[i] + solver.options_.initial_tangent_share * state.initial_tangent[i]) *
                strain_of(displacement_gradient[i]);
    if (load.predictor_ratio == 0) stress[i] += increment.stress[i];
  }
  Eigen::VectorXd right = -internal_force(mesh, increment.points, stress).force;
  if (load.predictor_ratio == 0) right += load.external_force;
  for (const auto& [dof, value] : load.prescribed) right[dof] = 0;
  const PartTimer timer(report.times, Part::solution);
  step = guess + lift + solver.solver_.solve(right);
  for (const auto& [dof, value] : load.prescribed) step[dof] = value;
  return step.allFinite() ? Failure{} : Failure{NewtonStatus::not_finite};
}

/// Moves by `step` and evaluates there. A step that fails, or that makes the residual grow strongly, is halved. If no
/// shorter step stays below the limit, the best of those that made the residual grow is kept, since it is a valid
/// iterate; a step that failed is never kept.
Failure NewtonSolver::Workspace::take_step() {
  const Eigen::VectorXd base = increment.displacement;
  const bool first = report.iterations == 1;  // its base lacks the prescribed values, so no shorter step has a meaning
  const double before = report.residual;
  Failure failure;
  std::optional<Trial> kept;  // the best of those whose residual grew
  for (int halving = 0; halving <= (first ? 0 : solver.options_.max_halvings); ++halving) {
    if (halving > 0) history.restart();
    increment.displacement = base + std::ldexp(1.0, -halving) * step;
    failure = evaluate();
    if (!failure) form_residual();
    if (!failure && !std::isfinite(report.residual)) failure = NewtonStatus::not_finite;
    if (failure) continue;
    const double limit = std::max(solver.options_.growth_limit * before, report.residual_bound);
    if (first || report.residual <= limit) {
      kept.reset();
      break;
    }
    if (!kept || report.residual < kept->report.residual) kept = Trial{increment, report};
  }
  if (kept) restore(std::move(*kept));
  if (failure && !kept) return failure;
  report.residual_history.push_back(report.residual);
  if (report.residual < best_residual) {
    best_residual = report.residual;
    best = increment.displacement;
  }
  history.add(increment.displacement, increment.residual);
  return {};
}

/// Goes back to a trial step, but keeps the counts of all work done since.
void NewtonSolver::Workspace::restore(Trial&& trial) {
  increment = std::move(trial.increment);
  trial.report.evaluations = report.evaluations;
  trial.report.work = report.work;
  trial.report.lane_steps = report.lane_steps;
  trial.report.times = report.times;
  report = std::move(trial.report);
}

/// Computes F_rel - I from the displacement, and from it stress and tangent.
Failure NewtonSolver::Workspace::evaluate() {
  const Mesh& mesh = solver.mesh_;
  if (!increment.displacement.allFinite()) return NewtonStatus::not_finite;
  {
    const PartTimer timer(report.times, Part::assembly);
    displacement_gradients(mesh, increment.points, increment.displacement, displacement_gradient);
  }
  for (int i = 0; i < mesh.n_points(); ++i) {
    Gradient h = displacement_gradient[i];
    if (solver.kinematics_ == Kinematics::fixed_mesh)
      h *= (Eigen::Matrix2d::Identity() + state.deformation[i]).inverse();
    if (!((Eigen::Matrix2d::Identity() + h).determinant() > 0)) return NewtonStatus::inverted_element;
    increment.gradients[i] = h;
  }
  const PartTimer timer(report.times, Part::material);
  const std::span<Tangent> wanted = renews_matrix() ? std::span(increment.tangent) : std::span<Tangent>();
  report.material = solver.material_.evaluate(increment.gradients, increment.stress, wanted);
  ++report.evaluations;
  report.work += report.material.work;
  report.lane_steps += report.material.lane_steps;
  report.times.material -= report.material.tangent_time;
  report.times.tangents += report.material.tangent_time;
  return report.material.usable ? Failure{} : Failure{NewtonStatus::material_failed};
}

void NewtonSolver::Workspace::form_residual() {
  const PartTimer timer(report.times, Part::assembly);
  const Mesh& mesh = solver.mesh_;
  const NewtonOptions& options = solver.options_;
  const InternalForce internal = internal_force(mesh, increment.points, increment.stress);
  Eigen::VectorXd& residual = increment.residual;
  residual = load.external_force - internal.force;
  increment.reactions = Eigen::VectorXd::Zero(mesh.n_dofs());
  for (const auto& [dof, value] : load.prescribed) {
    increment.reactions[dof] = -residual[dof];
    residual[dof] = 0;
  }
  report.residual = residual.norm();
  report.external_norm = load.external_force.norm();
  report.reaction_norm = increment.reactions.norm();
  report.reference_force = load.reference_force;
  const double allowed = options.tolerance * report.reference();
  const double noise = options.noise_factor *
                       noise_force(mesh, increment.points, constrained, report.material.stress_noise);
  report.noise_floor = std::min(noise, options.noise_limit * allowed);
  report.residual_bound = allowed + report.noise_floor;
  report.unsettled_force = noise_force(mesh, increment.points, constrained, report.material.unsettled_stress);
  report.largest_nodal_ratio = 0;
  double largest = -1;
  for (int node = 0; node < mesh.n_nodes(); ++node) {
    const double scale = internal.magnitude[node] + load.external_force.segment<2>(2 * node).norm();
    const double force = residual.segment<2>(2 * node).norm();
    if (force > largest) {
      largest = force;
      report.worst_place = state.coordinates.col(node);
    }
    if (force > 0) report.largest_nodal_ratio = std::max(report.largest_nodal_ratio, force / scale);
  }
}

/// Entries of K from the present tangents plus a share of the initial ones. This share changes the iterates, not the
/// answer.
std::vector<double> NewtonSolver::Workspace::stiffness(double share) {
  const PartTimer timer(report.times, Part::assembly);
  std::vector<Tangent> tangents = increment.tangent;
  for (std::size_t i = 0; i < tangents.size(); ++i) tangents[i] += share * state.initial_tangent[i];
  return solver.assembler_.assemble(increment.points, tangents, constrained);
}

bool NewtonSolver::Workspace::renews_matrix() const {
  return !load.keep_matrix && (report.iterations - 1) % solver.options_.refactor_every == 0;
}

/// K with the share that the options give; where that is not positive definite, ten and a hundred times the share.
Failure NewtonSolver::Workspace::refactor() {
  constexpr double smallest_share = 0.02;
  double share = solver.options_.initial_tangent_share;
  for (int attempt = 0; attempt < 3; ++attempt) {
    const std::vector<double> values = stiffness(share);
    if (std::any_of(values.begin(), values.end(), [](double v) { return !std::isfinite(v); }))
      return NewtonStatus::not_finite;
    const PartTimer timer(report.times, Part::solution);
    const FactorStatus status = solver.solver_.factorise(values);
    ++report.factorisations;
    if (status == FactorStatus::ok) return {};
    if (status == FactorStatus::out_of_memory) throw std::bad_alloc();
    share = 10 * std::max(share, smallest_share);
  }
  return NewtonStatus::not_positive_definite;
}

Failure NewtonSolver::Workspace::find_step() {
  const PartTimer timer(report.times, Part::solution);
  const NewtonOptions& options = solver.options_;
  const AndersonHistory::Step next = history.step(solver.solver_);
  if (!next.accelerated.allFinite()) return NewtonStatus::not_finite;
  report.correction_history.push_back(next.newton.norm());
  report.increment_norm = increment.displacement.norm() + load.moved;
  report.correction_bound = options.displacement_tolerance * report.increment_norm;
  if (const double noise = options.noise_factor * report.material.stress_noise; noise > 0)
    report.correction_bound += noise * solver.solver_.solve(noise_sample).norm();
  step = next.accelerated;
  return {};
}

bool NewtonSolver::Workspace::converged() const {
  const double correction = report.correction_history.back();
  if (load.settle && report.unsettled_force > solver.options_.tolerance * report.reference()) return false;
  return report.residual <= report.residual_bound &&
         (correction <= report.correction_bound || correction <= solver.options_.length_tolerance);
}

bool NewtonSolver::Workspace::near() const { return report.residual <= load.near_residual * report.reference(); }

/// Goes back to the best of the iterates that ended without converging, so that the material's last evaluation is the
/// one there.
void NewtonSolver::Workspace::return_to_best() {
  if (best.size() == 0 || increment.displacement == best) return;
  increment.displacement = best;
  if (!evaluate()) form_residual();
}

NewtonReport NewtonSolver::Workspace::stop(NewtonStatus status) {
  const bool ended = status == NewtonStatus::max_iterations || status == NewtonStatus::near;
  if (ended && load.leave_best) return_to_best();  // a failure keeps the report that says why
  report.status = status;
  return std::move(report);
}

NewtonSolver::NewtonSolver(const Mesh& mesh, MaterialBatch& material, Kinematics kinematics,
                           const NewtonOptions& options)
    : mesh_(mesh),
      material_(material),
      kinematics_(kinematics),
      options_(options),
      assembler_(mesh),
      solver_(assembler_.pattern()) {
  check(options);
  if (material.size() != static_cast<std::size_t>(mesh.n_points()))
    throw std::invalid_argument("newton: the material has " + std::to_string(material.size()) +
                                " points, but the mesh has " + std::to_string(mesh.n_points()));
}

void NewtonSolver::commit(MeshState& state, Increment& increment) {
  increment.last_part = increment.displacement;
  material_.commit();
  state.displacement += increment.displacement;
  state.last_increment = increment.displacement;
  if (!increment.tangent.empty()) state.tangent = increment.tangent;
  if (kinematics_ == Kinematics::updated_lagrangian) state.coordinates.reshaped() += increment.displacement;
  for (std::size_t i = 0; i < state.deformation.size(); ++i) {
    const Gradient& h = increment.gradients[i];
    state.deformation[i] += h + h * state.deformation[i];  // F_rel F_n - I without cancellation
  }
}

const char* to_string(NewtonStatus status) {
  switch (status) {
    case NewtonStatus::converged:
      return "converged";
    case NewtonStatus::max_iterations:
      return "max_iterations";
    case NewtonStatus::near:
      return "near";
    case NewtonStatus::material_failed:
      return "material_failed";
    case NewtonStatus::not_positive_definite:
      return "not_positive_definite";
    case NewtonStatus::inverted_element:
      return "inverted_element";
    case NewtonStatus::not_finite:
      return "not_finite";
  }
  return "unknown";
}

}  // namespace voussoir::fem
