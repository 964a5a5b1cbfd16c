#include "host/stages/ground.hpp"

namespace voussoir::host {

Eigen::VectorXd Ground::total_displacement() const {
  if (earlier.displacement.size() == 0) return state.displacement;
  return earlier.displacement + state.displacement;
}

std::vector<fem::PlaneTensor> Ground::total_strain() const {
  std::vector<fem::PlaneTensor> total = strain;
  for (std::size_t p = 0; p < earlier.strain.size(); ++p) total[p] += earlier.strain[p];
  return total;
}

void begin_stage(Ground& ground) {
  ground.state = fem::begin_stage(ground.mesh, ground.mesh.coordinates, ground.material);
  ground.strain.assign(static_cast<std::size_t>(ground.mesh.n_points()), fem::PlaneTensor::Zero());
  ground.earlier = {};
}

void go_on_to_next_stage(Ground& ground, fem::Kinematics before) {
  EarlierStages& earlier = ground.earlier;
  if (before == fem::Kinematics::updated_lagrangian) {
    earlier = {.displacement = ground.total_displacement(),
               .strain = ground.total_strain(),
               .coordinates = ground.state.coordinates};
  }
  ground.state = fem::begin_stage(ground.mesh, ground.stage_coordinates(), ground.material);
  ground.strain.assign(static_cast<std::size_t>(ground.mesh.n_points()), fem::PlaneTensor::Zero());
}

}  // namespace voussoir::host
