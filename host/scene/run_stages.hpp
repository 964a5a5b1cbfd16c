#pragma once
/// Takes the ground of a scene through its stages, one after the other. Every kind on a mesh runs here.

#include <functional>

#include "host/scene/rest.hpp"
#include "host/scene/scene.hpp"
#include "host/scene/scene_loads.hpp"
#include "host/stages/ground_run.hpp"
#include "host/stages/stage.hpp"

namespace voussoir::host {

/// What a kind adds to the stages of its scene; each may be empty.
struct StageAdditions {
  /// Called when the ground has begun a stage, before its first increment, and not where a run goes on within the
  /// stage.
  std::function<void(const StagePlan&, const SceneLoads&, const FadingForces&)> on_start;
  /// Gives the stage its reports and its data in checkpoints.
  std::function<void(const StagePlan&, Stage&)> complete;
};

/// Starts with the first stage, or goes on in the stage of the checkpoint with which the record goes on. `scene.mesh`
/// is the mesh of the run; its elements are dug out as the stages say.
/// @param rest null where no stage presses at rest
[[nodiscard]] RunStatus run_stages(GroundRun& run, Scene& scene, const std::vector<StagePlan>& plans,
                                   const GroundAtRest* rest, const StageAdditions& additions);

[[nodiscard]] fem::Kinematics kinematics_of(const StagePlan& plan);

/// Records the state at the start of a stage as its increment 0. `columns` are columns of the stage.
void record_stage_start(GroundRun& run, const StagePlan& plan, const Eigen::VectorXd& reactions,
                        const io::Quantities& columns);

}  // namespace voussoir::host
