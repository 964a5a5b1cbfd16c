#include "host/stages/stage_driver.hpp"

#include <spdlog/fmt/fmt.h>

#include "host/process/interrupt.hpp"
#include "host/process/resources.hpp"
#include "host/stages/stage_run.hpp"

namespace voussoir::host {
namespace {

fem::StepOptions step_options(const NewtonCase& newton) {
  fem::StepOptions options;
  options.smallest = newton.smallest_cut;
  options.relax_below = newton.relax_below;
  options.relaxation.max_substeps = newton.relax_substeps;
  options.relaxation.max_attempts = newton.relax_attempts;
  options.relaxation.near_residual = newton.relax_near;
  return options;
}

/// Writes the lines at the end of a stage to the log.
void report_totals(GroundRun& run, const std::string& stage) {
  const StageTotals& totals = run.recorder().stage_totals();
  run.log().line(fmt::format("{}: {}, written in {:.2g} s, {:.2g} s of them on a processor; peak memory {:.0f} MB",
                             stage, run.recorder().disk_use(), totals.writer.wall, totals.writer.processor,
                             peak_memory() * 1e-6));
  for (const std::string& line : {lanes_line(totals), unsettled_line(totals, run.ground().strain.size()),
                                  deferral_line(totals, run.settings().defer)}) {
    if (!line.empty()) run.log().line(line);
  }
  const std::string beyond = range_line(totals, run.ground().strain.size());
  if (!beyond.empty()) run.log().warning(beyond);
}

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

RunStatus advance_stage(GroundRun& run, const Stage& stage) {
  StageRun progress(run, stage);
  if (progress.done() == static_cast<int>(stage.targets.size())) return RunStatus::finished;
  if (interrupted()) return RunStatus::interrupted;

  Ground& ground = run.ground();
  RunRecorder& recorder = run.recorder();
  fem::NewtonSolver solver(ground.mesh, ground.material, stage.kinematics, newton_options(run.settings().newton));
  solver.on_iterate = [&](const fem::Iterate& iterate) { recorder.show_iterate(ground.state.parameter, iterate); };
  recorder.begin_stage(stage.name, progress.done(), static_cast<int>(stage.targets.size()));
  const fem::StepReport report = fem::advance_load(
      solver, ground.state, stage.path, stage.targets, step_options(run.settings().newton),
      {.on_converged = [&](const fem::ConvergedStep& step) { return progress.converged(step); },
       .on_failed = [&](const fem::FailedStep& step) { progress.failed(step); }});
  progress.end();
  report_totals(run, stage.name);
  if (report.status == fem::StepStatus::gave_up) {
    run.log().failure(stage.name, report.message);
    return RunStatus::failed;
  }
  const bool complete = ground.state.parameter == stage.targets.back();
  return complete ? RunStatus::finished : RunStatus::interrupted;
}

}  // namespace voussoir::host
