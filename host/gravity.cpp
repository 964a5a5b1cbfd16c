// Stage "gravity", and the forces that the stages share.
#include <algorithm>
#include <cmath>

#include "fem/boundary.hpp"
#include "host/stages.hpp"

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

GeostaticCheck check_geostatic(const Ground& ground) {
  const GroundCase& soil = ground.input.ground;
  const auto n = static_cast<std::size_t>(ground.mesh.n_points());
  std::vector<fem::Stress> stress(n);
  std::vector<fem::Tangent> tangent(n);
  ground.material.committed(stress, tangent);
  const fem::GaussPoints points = fem::gauss_points(ground.mesh, ground.mesh.coordinates);
  const fem::Point axis(0.0, soil.axis_height());
  GeostaticCheck check;
  double deflections = 0;
  std::size_t counted = 0;
  for (std::size_t p = 0; p < n; ++p) {
    const fem::Point x = points.positions.col(static_cast<Eigen::Index>(p));
    if ((x - axis).norm() <= soil.diameter) continue;  // within D/2 of the opening's edge
    const double expected = soil.unit_weight * (soil.height - x.y()) + soil.surcharge;
    const double error = std::abs(-stress[p][1] - expected);
    const double k0 = stress[p][0] / stress[p][1];
    const double deflection = std::abs(major_axis_from_vertical(stress[p]));
    check.vertical_error = std::max(check.vertical_error, error);
    check.vertical_ratio = std::max(check.vertical_ratio, error / (0.05 * expected + 1.0e3));
    check.k0_minimum = std::min(check.k0_minimum, k0);
    check.k0_maximum = std::max(check.k0_maximum, k0);
    check.deflection_max = std::max(check.deflection_max, deflection);
    deflections += deflection;
    ++counted;
  }
  check.deflection_mean = counted > 0 ? deflections / static_cast<double>(counted) : 0.0;
  return check;
}

}  // namespace voussoir::host
