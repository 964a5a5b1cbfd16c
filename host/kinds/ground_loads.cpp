#include "host/kinds/ground_loads.hpp"

#include "fem/load_stepper.hpp"

namespace voussoir::host {

std::vector<double> gravity_targets(const GroundCase& soil, const GravityCase& gravity) {
  return fem::geometric_targets(soil.surcharge / (soil.unit_weight * soil.height), gravity.ratio, gravity.uniform_step);
}

Eigen::VectorXd ground_weight(const fem::Mesh& mesh, const GroundCase& soil, double load_factor) {
  return fem::body_force(mesh, mesh.coordinates, {0.0, -load_factor * soil.unit_weight}) +
         fem::pressure_force(mesh.coordinates, mesh.edge_set("top"), soil.surcharge);
}

Eigen::VectorXd opening_tractions(const fem::Mesh& mesh, const GroundCase& soil, const K0Table& k0,
                                  double load_factor) {
  const fem::GeostaticStress at_rest{.unit_weight = soil.unit_weight,
                                     .height = soil.height,
                                     .surcharge = soil.surcharge,
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

fem::Constraints volume_loss_constraints(const fem::Mesh& mesh, double from, double to) {
  fem::Constraints constraints = ground_supports(mesh);
  fem::constrain_volume_loss(constraints, mesh, from, to);
  return constraints;
}

}  // namespace voussoir::host
