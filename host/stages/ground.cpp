#include "host/stages/ground.hpp"

namespace voussoir::host {

void begin_stage(Ground& ground) {
  ground.state = fem::begin_stage(ground.mesh, ground.mesh.coordinates, ground.material);
  ground.strain.assign(static_cast<std::size_t>(ground.mesh.n_points()), fem::PlaneTensor::Zero());
}

}  // namespace voussoir::host
