#include "host/scene/run_stages.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <stdexcept>

#include "host/stages/ground_checkpoint.hpp"
#include "host/stages/ground_record.hpp"
#include "host/stages/stage_driver.hpp"

namespace voussoir::host {
namespace {

void save(const FadingForces& forces, io::Checkpoint& checkpoint) {
  if (forces.kept.size() > 0) put_vector(checkpoint, "kept_forces", forces.kept);
  if (forces.fading.size() > 0) put_vector(checkpoint, "fading_forces", forces.fading);
}

/// The forces of a checkpoint; none where it has none.
FadingForces forces_from(const io::Checkpoint& checkpoint, const fem::Mesh& mesh) {
  const auto read = [&](const char* name) {
    return checkpoint.has(name) ? get_vector(checkpoint, name, static_cast<std::size_t>(mesh.n_dofs()))
                                : Eigen::VectorXd();
  };
  return {read("kept_forces"), read("fading_forces")};
}

/// The number of the stage with which the run begins.
std::size_t first_stage(const RunRecorder& recorder, const std::vector<StagePlan>& plans) {
  if (recorder.resumed() == nullptr) return 0;
  const auto found = std::find_if(plans.begin(), plans.end(),
                                  [&](const StagePlan& plan) { return plan.input.name == recorder.resumed_stage(); });
  if (found == plans.end())
    throw std::runtime_error(
        fmt::format("the checkpoint is of a stage {} that the case does not have", recorder.resumed_stage()));
  return static_cast<std::size_t>(found - plans.begin());
}

/// Takes the elements that the stage has dug out from the mesh and from the material.
void dig(GroundRun& run, Scene& scene, const StagePlan& plan) {
  scene.mesh.dug_out = plan.dug_out;
  std::vector<std::size_t> points;
  for (std::size_t e = 0; e < plan.dug_out.size(); ++e) {
    if (plan.dug_out[e] == 0) continue;
    for (std::size_t p = 4 * e; p < 4 * e + 4; ++p) points.push_back(p);
  }
  if (!points.empty()) run.ground().material.retire(points);
}

Stage stage_of(const StagePlan& plan, const SceneLoads& loads, const FadingForces& forces, bool last) {
  Stage stage;
  stage.name = plan.input.name;
  stage.kinematics = kinematics_of(plan);
  stage.path = loads.path(forces);
  stage.targets = plan.targets;
  stage.last = last;
  return stage;
}

}  // namespace

fem::Kinematics kinematics_of(const StagePlan& plan) {
  return plan.input.geometry == LossGeometry::fixed_mesh ? fem::Kinematics::fixed_mesh
                                                         : fem::Kinematics::updated_lagrangian;
}

void record_stage_start(GroundRun& run, const StagePlan& plan, const Eigen::VectorXd& reactions,
                        const io::Quantities& columns) {
  IncrementReport start;
  start.info.stage = plan.input.name;
  start.info.converged = true;
  start.info.extra = columns;
  record_ground(run.ground(), start, reactions, run.settings().output, run.recorder());
  run.recorder().hand_over();
}

RunStatus run_stages(GroundRun& run, Scene& scene, const std::vector<StagePlan>& plans, const GroundAtRest* rest,
                     const StageAdditions& additions) {
  const io::Checkpoint* checkpoint = run.recorder().resumed();
  const std::size_t first = first_stage(run.recorder(), plans);
  FadingForces forces;
  if (checkpoint != nullptr) forces = forces_from(*checkpoint, scene.mesh);
  for (std::size_t k = first; k < plans.size(); ++k) {
    const StagePlan& plan = plans[k];
    const StagePlan* before = k > 0 ? &plans[k - 1] : nullptr;
    dig(run, scene, plan);
    const SceneLoads loads(scene, plan, run.ground(), rest);
    if (checkpoint == nullptr || k > first) {
      if (before != nullptr) go_on_to_next_stage(run.ground(), kinematics_of(*before));
      loads.begin(before, forces);
      if (additions.on_start) additions.on_start(plan, loads, forces);
    }
    Stage stage = stage_of(plan, loads, forces, k + 1 == plans.size());
    if (additions.complete) additions.complete(plan, stage);
    stage.on_checkpoint = [&forces, own = stage.on_checkpoint](io::Checkpoint& made) {
      save(forces, made);
      if (own) own(made);
    };
    const RunStatus status = advance_stage(run, stage);
    if (status != RunStatus::finished) return status;
  }
  return RunStatus::finished;
}

}  // namespace voussoir::host
