#include "host/stages/stage_run.hpp"

#include <spdlog/fmt/fmt.h>

#include <Kokkos_Core.hpp>
#include <Kokkos_Profiling_ScopedRegion.hpp>
#include <algorithm>
#include <string>
#include <utility>

#include "host/process/interrupt.hpp"
#include "host/process/resources.hpp"
#include "host/stages/ground_checkpoint.hpp"
#include "host/stages/ground_record.hpp"

namespace voussoir::host {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A force over the reference force of the tolerance.
double relative(double force, const fem::NewtonReport& report, double tolerance) {
  const double reference = (report.residual_bound - report.noise_floor) / tolerance;
  return reference > 0 ? force / reference : force;
}

}  // namespace

StageRun::StageRun(GroundRun& run, const Stage& stage) : run_(run), stage_(stage) {
  done_ = static_cast<int>(std::count_if(stage.targets.begin(), stage.targets.end(),
                                         [&](double target) { return target <= run.ground().state.parameter; }));
}

bool StageRun::converged(const fem::ConvergedStep& step) {
  tally(step.report);
  std::vector<fem::PlaneTensor>& strain = run_.ground().strain;
  for (std::size_t p = 0; p < strain.size(); ++p) {
    const fem::Gradient& h = step.increment.gradients[p];
    strain[p] += fem::PlaneTensor(h(0, 0), h(1, 1), 0.5 * (h(0, 1) + h(1, 0)));
  }
  if (stage_.on_step) stage_.on_step(step);
  if (!step.target) return true;
  const bool stop = interrupted();  // looked at only once, so that a run that stops here has written its checkpoint
  finish_increment(step, stop);
  return !stop;
}

void StageRun::failed(const fem::FailedStep& step) {
  tally(step.report);
  ++effort_.cuts;
  ++run_.recorder().stage_totals().cuts;
  run_.log().line(fmt::format("{}: the step from {:.6g} to {:.6g} is cut: {} {}", stage_.name, step.from, step.to,
                              fem::to_string(step.report.status), step.report.material.message));
  std::string residuals;
  for (const double r : step.report.residual_history) {
    residuals += fmt::format(" {:.1e}", relative(r, step.report, run_.settings().newton.tolerance));
  }
  run_.log().detail("the residuals of its iterates were" + residuals);
}

void StageRun::end() {
  const auto start = Clock::now();
  run_.recorder().finish();
  StageTotals& totals = run_.recorder().stage_totals();
  totals.output += seconds_since(start);
  totals.wall += seconds_since(effort_.since);
}

void StageRun::tally(const fem::NewtonReport& report) {
  effort_.iterations += report.iterations;
  effort_.evaluations += report.evaluations;
  effort_.particle_steps += static_cast<double>(report.work);
  effort_.relaxations += report.relaxations;
  if (report.status == fem::NewtonStatus::converged) {
    effort_.viscous_work += report.viscous_work;
    effort_.deferral_error = std::max(effort_.deferral_error, report.material.deferral_error);
  }
  effort_.times += report.times;
  StageTotals& totals = run_.recorder().stage_totals();
  totals.particle_steps += static_cast<double>(report.work);
  totals.lane_steps += static_cast<double>(report.lane_steps);
  totals.parts += report.times;
}

void StageRun::finish_increment(const fem::ConvergedStep& step, bool stop) {
  ++done_;
  IncrementReport increment = report_of(step);
  if (stage_.on_record) stage_.on_record(increment);
  increment.info.wall_s = seconds_since(effort_.since);
  add_to_totals(increment);
  {
    const Kokkos::Profiling::ScopedRegion region("output");
    const OutputCase& output = run_.settings().output;
    const bool last_target = done_ == static_cast<int>(stage_.targets.size());
    if (last_target || done_ % output.every == 0) {
      record_ground(run_.ground(), increment, step.increment.reactions, output, run_.recorder());
    }
    if (last_target || stop || done_ % output.checkpoint_every == 0) add_checkpoint(stage_.last && last_target);
    run_.recorder().add_line(increment);
    run_.recorder().hand_over();
  }
  output_ = seconds_since(effort_.since) - increment.info.wall_s;
  run_.recorder().stage_totals().output += output_;
  run_.recorder().stage_totals().wall += output_;
  effort_ = {};
}

IncrementReport StageRun::report_of(const fem::ConvergedStep& step) const {
  const double tolerance = run_.settings().newton.tolerance;
  IncrementReport increment;
  io::IncrementInfo& info = increment.info;
  info.stage = stage_.name;
  info.stage_index = done_;
  info.load_parameter = step.to;
  info.converged = true;
  info.iterations = effort_.iterations;
  info.evaluations = effort_.evaluations;
  info.cuts = effort_.cuts;
  info.residual = relative(step.report.residual, step.report, tolerance);
  info.particle_steps = effort_.particle_steps;
  for (const double r : step.report.residual_history) {
    info.residual_history.push_back(relative(r, step.report, tolerance));
  }
  increment.equilibrium = equilibrium_of(step.report);
  // RVEs that are not at rest leave the equilibrium open where their possible error passes the tolerance.
  info.converged = increment.equilibrium->step_limit_points == 0 || increment.equilibrium->unsettled <= 1;
  return increment;
}

EquilibriumReport StageRun::equilibrium_of(const fem::NewtonReport& report) const {
  const double tolerance = run_.settings().newton.tolerance;
  EquilibriumReport found;
  found.largest_nodal_ratio = report.largest_nodal_ratio;
  found.residual_bound = relative(report.residual_bound, report, tolerance);
  found.noise_floor = report.noise_floor;
  found.open_points = report.material.open;
  found.step_limit_points = report.material.step_limit;
  if (report.material.mean_overlap) {
    found.out_of_range_points = report.material.out_of_range;
    found.mean_overlap = report.material.mean_overlap;
  }
  found.unsettled = relative(report.unsettled_force, report, tolerance) / tolerance;
  if (report.material.slowest_steps > 0) {
    found.slowest_point = report.material.slowest;
    found.slowest_steps = report.material.slowest_steps;
  }
  found.relaxations = effort_.relaxations;
  found.viscous_work = effort_.viscous_work;
  if (run_.settings().defer > 0) {
    found.deferred_points = report.material.deferred;
    found.deferral_error = effort_.deferral_error;
  }
  found.time_grains = effort_.times.material;
  found.time_tangents = effort_.times.tangents;
  found.time_assembly = effort_.times.assembly;
  found.time_solve = effort_.times.solve;
  found.time_output = output_;
  found.peak_memory = peak_memory();
  return found;
}

void StageRun::add_to_totals(const IncrementReport& increment) {
  StageTotals& totals = run_.recorder().stage_totals();
  // NOLINTNEXTLINE(bugprone-unchecked-optional-access): value() itself checks, and throws.
  const EquilibriumReport& found = increment.equilibrium.value();
  totals.evaluations.push_back(increment.info.evaluations);
  totals.step_limit_points.push_back(static_cast<double>(found.step_limit_points));
  totals.unsettled.push_back(found.unsettled);
  if (found.out_of_range_points) totals.out_of_range_points.push_back(static_cast<double>(*found.out_of_range_points));
  if (found.mean_overlap) totals.mean_overlap.push_back(*found.mean_overlap);
  if (found.deferral_error) totals.deferral_error.push_back(*found.deferral_error);
  totals.wall += increment.info.wall_s;
}

void StageRun::add_checkpoint(bool finished) {
  io::Checkpoint checkpoint;
  save(run_.ground(), checkpoint);
  if (stage_.on_checkpoint) stage_.on_checkpoint(checkpoint);
  run_.recorder().add_checkpoint(std::move(checkpoint), stage_.name, done_, finished);
}

}  // namespace voussoir::host
