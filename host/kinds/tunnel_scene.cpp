#include "host/kinds/tunnel_scene.hpp"

#include <utility>

namespace voussoir::host {
namespace {

StageCase gravity_stage() {
  StageCase stage;
  stage.name = "gravity";
  stage.gravity = 1.0;
  stage.geometry = LossGeometry::fixed_mesh;
  PressCase at_rest;
  at_rest.boundary = "opening";
  at_rest.kind = PressKind::at_rest;
  stage.presses = {at_rest};
  return stage;
}

StageCase volume_loss_stage(const VolumeLossCase& loss) {
  StageCase stage;
  stage.name = "volume_loss";
  stage.end = loss.total;
  stage.steps = loss.increments;
  stage.geometry = loss.geometry;
  MoveCase shrink;
  shrink.boundary = "opening";
  shrink.area = -1.0;  // at V_l = 1
  shrink.about.name = "invert";
  stage.moves = {shrink};
  return stage;
}

}  // namespace

Scene tunnel_scene(const Case& input, fem::Mesh mesh) {
  Scene scene{.input = {}, .mesh = std::move(mesh), .pressure = input.ground.surcharge, .gravity = input.gravity};
  RegionCase ground;
  ground.unit_weight = input.ground.unit_weight;
  scene.input.regions = {ground};
  scene.input.supports = {{.boundaries = {"base"}, .point = {}, .x = true, .y = true},
                          {.boundaries = {"side", "axis"}, .point = {}, .x = true}};
  scene.input.stages = {gravity_stage(), volume_loss_stage(input.volume_loss)};
  scene.dead_pressure = true;
  return scene;
}

}  // namespace voussoir::host
