#include "host/kinds/gravity.hpp"

#include "host/kinds/ground_loads.hpp"
#include "host/stages/stage_driver.hpp"

namespace voussoir::host {

RunStatus settle_under_gravity(GroundRun& run, const GroundCase& soil, const GravityCase& gravity, const K0Table& k0) {
  const fem::Mesh& mesh = run.ground().mesh;
  const fem::Constraints supports = ground_supports(mesh);
  Stage stage;
  stage.name = "gravity";
  stage.kinematics = fem::Kinematics::fixed_mesh;
  stage.path.external_force = [&](double lambda) {
    return Eigen::VectorXd(ground_weight(mesh, soil, lambda) + opening_tractions(mesh, soil, k0, lambda));
  };
  // NOLINTNEXTLINE(performance-no-automatic-move): each call gives a copy, so that there is nothing to move.
  stage.path.prescribed_increment = [&](double, double) { return supports; };
  stage.path.reference_force = stage.path.external_force(1.0).norm();
  stage.targets = gravity_targets(soil, gravity);
  return advance_stage(run, stage);
}

}  // namespace voussoir::host
