#include "host/stages/stage_driver.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <chrono>

#include "host/material/snapshot_source.hpp"
#include "host/process/interrupt.hpp"
#include "host/process/resources.hpp"

namespace voussoir::host {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// The residual's norm over the reference that the tolerance is relative to.
double relative(double residual, const fem::NewtonReport& report, double tolerance) {
  const double reference = (report.residual_bound - report.noise_floor) / tolerance;
  return reference > 0 ? residual / reference : residual;
}

/// Columns that say how hard the equilibrium was to find: `residual_bound` is what `residual` was held to, the
/// tolerance and the noise floor of the points' stresses.
void add_report_columns(const Ground& ground, const fem::NewtonReport& report, io::IncrementInfo& info) {
  const double tolerance = ground.input.newton.tolerance;
  info.extra["largest_nodal_ratio"] = {report.largest_nodal_ratio, "-"};
  info.extra["residual_bound"] = {relative(report.residual_bound, report, tolerance), "-"};
  info.extra["noise_floor"] = {report.noise_floor, "N/m"};
  info.extra["open_points"] = {static_cast<double>(report.material.open), "-"};
  info.extra["step_limit_points"] = {static_cast<double>(report.material.step_limit), "-"};
  info.extra["unsettled"] = {relative(report.unsettled_force, report, tolerance) / tolerance, "-"};
  if (report.material.slowest_steps > 0) {
    info.extra["slowest_point"] = {static_cast<double>(report.material.slowest), "-"};
    info.extra["slowest_steps"] = {static_cast<double>(report.material.slowest_steps), "-"};
  }
}

/// One stage as it runs. Iterations, evaluations and cuts are summed from target to target.
class StageRun {
 public:
  StageRun(Ground& ground, const Stage& stage, RunRecorder& recorder)
      : ground_(ground), stage_(stage), recorder_(recorder), since_(Clock::now()) {
    info_.stage = stage.name;
    done_ = static_cast<int>(std::count_if(stage.targets.begin(), stage.targets.end(),
                                           [&](double target) { return target <= ground.state.parameter; }));
  }

  [[nodiscard]] int done() const { return done_; }

  /// The wall time since the last increment, of tries that led to none.
  void end() { recorder_.stage_totals().wall += seconds_since(since_); }

  /// False: stop here.
  bool converged(const fem::ConvergedStep& step) {
    tally(step.report);
    for (std::size_t p = 0; p < ground_.strain.size(); ++p) {
      const fem::Gradient& h = step.increment.gradients[p];
      ground_.strain[p] += fem::PlaneTensor(h(0, 0), h(1, 1), 0.5 * (h(0, 1) + h(1, 0)));
    }
    if (stage_.on_step) stage_.on_step(step);
    if (!step.target) return true;
    const bool stop = interrupted();  // asked once: whoever stops here has a checkpoint
    finish_increment(step, stop);
    return !stop;
  }

  void failed(const fem::FailedStep& step) {
    tally(step.report);
    ++info_.cuts;
    ++recorder_.stage_totals().cuts;
    recorder_.log().line(fmt::format("{}: step {:.6g} to {:.6g} cut: {} {}", stage_.name, step.from, step.to,
                                     fem::to_string(step.report.status), step.report.material.message));
    std::string residuals;
    for (const double r : step.report.residual_history) {
      residuals += fmt::format(" {:.1e}", relative(r, step.report, ground_.input.newton.tolerance));
    }
    recorder_.log().detail("its residuals:" + residuals);
  }

 private:
  void tally(const fem::NewtonReport& report) {
    info_.iterations += report.iterations;
    info_.evaluations += report.evaluations;
    info_.particle_steps += static_cast<double>(report.work);
    relaxations_ += report.relaxations;
    if (report.status == fem::NewtonStatus::converged) {
      viscous_work_ += report.viscous_work;
      deferral_error_ = std::max(deferral_error_, report.material.deferral_error);
    }
    times_ += report.times;
    recorder_.stage_totals().particle_steps += static_cast<double>(report.work);
    recorder_.stage_totals().parts += report.times;
  }

  /// Evaluations and wall time of an increment that converged. Its output is still to come: the column has that of the
  /// increment before.
  void count_increment() {
    info_.wall_s = seconds_since(since_);
    info_.extra["time_grains"] = {times_.material, "s"};
    info_.extra["time_assembly"] = {times_.assembly, "s"};
    info_.extra["time_solve"] = {times_.solve, "s"};
    info_.extra["time_output"] = {output_, "s"};
    info_.extra["peak_memory"] = {peak_memory(), "B"};
    recorder_.stage_totals().evaluations.push_back(info_.evaluations);
    recorder_.stage_totals().unsettled.push_back(info_.extra.at("step_limit_points").value);
    recorder_.stage_totals().unsettled_share.push_back(info_.extra.at("unsettled").value);
    recorder_.stage_totals().wall += info_.wall_s;
  }

  /// How many RVEs answered by their tangent, and the largest error that the increment's grains have shown of such
  /// answers.
  void add_deferral(const fem::NewtonReport& report) {
    info_.extra["deferred_points"] = {static_cast<double>(report.material.deferred), "-"};
    info_.extra["deferral_error"] = {deferral_error_, "-"};
    recorder_.stage_totals().deferral_error.push_back(deferral_error_);
    deferral_error_ = 0;
  }

  /// The increment is on the disk.
  void close_increment() {
    output_ = seconds_since(since_) - info_.wall_s;
    recorder_.stage_totals().output += output_;
    recorder_.stage_totals().wall += output_;
    info_ = {};
    info_.stage = stage_.name;
    times_ = {};
    since_ = Clock::now();
  }

  void finish_increment(const fem::ConvergedStep& step, bool stop) {
    const double tolerance = ground_.input.newton.tolerance;
    info_.stage_index = ++done_;
    info_.load_parameter = step.to;
    info_.volume_loss = stage_.loses_volume ? step.to : 0.0;
    info_.converged = true;
    info_.residual = relative(step.report.residual, step.report, tolerance);
    for (const double r : step.report.residual_history) {
      info_.residual_history.push_back(relative(r, step.report, tolerance));
    }
    add_report_columns(ground_, step.report, info_);
    info_.extra["relaxations"] = {static_cast<double>(relaxations_), "-"};
    info_.extra["viscous_work"] = {viscous_work_, "J/m"};
    relaxations_ = 0;
    viscous_work_ = 0;
    if (ground_.input.engine.defer > 0) add_deferral(step.report);
    if (stage_.on_record) stage_.on_record(info_);
    count_increment();
    const bool last_target = done_ == static_cast<int>(stage_.targets.size());
    if (last_target || done_ % ground_.input.output.every == 0) {
      record_ground(ground_, info_, step.increment.reactions, recorder_);
    }
    if (last_target || stop || done_ % ground_.input.output.checkpoint_every == 0)
      checkpoint(stage_.last && last_target);
    recorder_.report(info_);
    close_increment();
  }

  void checkpoint(bool finished) {
    io::Checkpoint checkpoint;
    save(ground_, checkpoint);
    if (stage_.on_checkpoint) stage_.on_checkpoint(checkpoint);
    recorder_.save(std::move(checkpoint), stage_.name, done_, finished);
  }

  Ground& ground_;
  const Stage& stage_;
  RunRecorder& recorder_;
  io::IncrementInfo info_;
  fem::PartTimes times_;  ///< of the present increment
  double output_ = 0;     ///< of the last increment [s]
  Clock::time_point since_;
  int relaxations_ = 0;
  double viscous_work_ = 0;
  double deferral_error_ = 0;
  int done_ = 0;
};

}  // namespace

fem::NewtonOptions newton_options(const NewtonCase& newton) {
  fem::NewtonOptions options;
  options.tolerance = newton.tolerance;
  options.displacement_tolerance = newton.displacement_tolerance;
  options.max_iterations = newton.maximum_iterations;
  options.anderson_depth = newton.anderson_depth;
  options.initial_tangent_share = newton.initial_tangent_fraction;
  return options;
}

void record_ground(const Ground& ground, const io::IncrementInfo& info, const Eigen::VectorXd& reactions,
                   RunRecorder& recorder) {
  std::vector<io::RveSnapshot> snapshots;
  if (const auto* source = dynamic_cast<const SnapshotSource*>(&ground.material)) {
    if (!ground.input.output.rves.empty()) snapshots = source->snapshots(ground.input.output.rves);
  }
  std::vector<io::Field> fields = result_fields(ground, reactions);
  const std::vector<std::string>& wanted = ground.input.output.fields;
  std::erase_if(fields, [&](const io::Field& field) {
    return !wanted.empty() && std::find(wanted.begin(), wanted.end(), field.name) == wanted.end();
  });
  recorder.write(info, fields, snapshots, moved_coordinates(ground));
}

RunStatus advance_stage(Ground& ground, const Stage& stage, RunRecorder& recorder) {
  StageRun run(ground, stage, recorder);
  if (run.done() == static_cast<int>(stage.targets.size())) return RunStatus::finished;
  if (interrupted()) return RunStatus::interrupted;

  fem::NewtonSolver solver(ground.mesh, ground.material, stage.kinematics, newton_options(ground.input.newton));
  solver.on_iterate = [&](const fem::Iterate& iterate) { recorder.show_iterate(ground.state.parameter, iterate); };
  recorder.begin_stage(stage.name, run.done(), static_cast<int>(stage.targets.size()));

  fem::StepOptions options;
  options.smallest = ground.input.newton.smallest_cut;
  options.relax_below = ground.input.newton.relax_below;
  options.relaxation.max_substeps = ground.input.newton.relax_substeps;
  options.relaxation.max_attempts = ground.input.newton.relax_attempts;
  options.relaxation.near_residual = ground.input.newton.relax_near;
  const fem::StepReport report = fem::advance_load(
      solver, ground.state, stage.path, stage.targets, options,
      {.on_converged = [&](const fem::ConvergedStep& step) { return run.converged(step); },
       .on_failed = [&](const fem::FailedStep& step) { run.failed(step); }});
  run.end();
  recorder.log().line(
      fmt::format("{}: {}, peak memory {:.0f} MB", stage.name, recorder.disk_use(), peak_memory() * 1e-6));
  const std::string unsettled = unsettled_line(recorder.stage_totals(), ground.strain.size());
  if (!unsettled.empty()) recorder.log().line(unsettled);
  const std::string deferral = deferral_line(recorder.stage_totals(), ground.input.engine.defer);
  if (!deferral.empty()) recorder.log().line(deferral);
  if (report.status == fem::StepStatus::gave_up) {
    recorder.log().line(fmt::format("{} failed: {}", stage.name, report.message));
    return RunStatus::failed;
  }
  const bool complete = ground.state.parameter == stage.targets.back();
  return complete ? RunStatus::finished : RunStatus::interrupted;
}

}  // namespace voussoir::host
