// Stage "gravity", and the forces that the stages share.

#include "fem/boundary.hpp"
#include "host/stages/stages.hpp"

namespace voussoir::host {

Eigen::VectorXd ground_weight(const fem::Mesh& mesh, const GroundCase& ground, double load_factor) {
  return fem::body_force(mesh, mesh.coordinates, {0.0, -load_factor * ground.unit_weight}) +
         fem::pressure_force(mesh.coordinates, mesh.edge_set("top"), ground.surcharge);
}

Eigen::VectorXd opening_tractions(const fem::Mesh& mesh, const GroundCase& ground, const K0Table& k0,
                                  double load_factor) {
  const fem::GeostaticStress at_rest{.unit_weight = ground.unit_weight,
                                     .height = ground.height,
                                     .surcharge = ground.surcharge,
                                     .load_factor = load_factor,
                                     .k0 = [&k0](double s_yy) { return k0.at(-s_yy); }};
  return fem::traction_force(mesh.coordinates, mesh.edge_set("opening"), at_rest);
}

fem::Constraints ground_supports(const fem::Mesh& mesh) {
  fem::Constraints supports;
  fem::constrain(supports, mesh.node_set("base"), 0, 0.0);
  fem::constrain(supports, mesh.node_set("base"), 1, 0.0);
  fem::constrain(supports, mesh.node_set("side"), 0, 0.0);
  fem::constrain(supports, mesh.node_set("axis"), 0, 0.0);
  return supports;
}

std::vector<double> gravity_targets(const Case& input) {
  const GroundCase& soil = input.ground;
  return fem::geometric_targets(soil.surcharge / (soil.unit_weight * soil.height), input.gravity.ratio,
                                input.gravity.uniform_step);
}

RunStatus settle_under_gravity(Ground& ground, const K0Table& k0, RunRecorder& recorder, bool last) {
  const GroundCase& soil = ground.input.ground;
  const fem::Mesh& mesh = ground.mesh;
  const fem::Constraints supports = ground_supports(mesh);
  Stage stage;
  stage.name = "gravity";
  stage.kinematics = fem::Kinematics::fixed_mesh;
  stage.path.external_force = [&](double lambda) {
    return Eigen::VectorXd(ground_weight(mesh, soil, lambda) + opening_tractions(mesh, soil, k0, lambda));
  };
  stage.path.prescribed_increment = [&](double, double) { return supports; };
  stage.path.reference_force = stage.path.external_force(1.0).norm();
  stage.targets = gravity_targets(ground.input);
  stage.last = last;
  return advance_stage(ground, stage, recorder);
}

}  // namespace voussoir::host
