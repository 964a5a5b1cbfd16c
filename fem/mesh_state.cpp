#include "fem/mesh_state.hpp"

namespace voussoir::fem {

MeshState begin_stage(const Mesh& mesh, const Coordinates& coordinates, const MaterialBatch& material,
                      double parameter) {
  MeshState state;
  state.displacement = Eigen::VectorXd::Zero(mesh.n_dofs());
  state.last_increment = Eigen::VectorXd::Zero(mesh.n_dofs());
  state.coordinates = coordinates;
  state.deformation.assign(mesh.n_points(), Gradient::Zero());
  state.initial_tangent.resize(material.size());
  std::vector<Stress> stress(material.size());
  material.committed(stress, state.initial_tangent);
  state.tangent = state.initial_tangent;
  state.start = state.parameter = parameter;
  return state;
}

}  // namespace voussoir::fem
