#include "host/kinds/opening_check.hpp"

#include <cmath>
#include <vector>

#include "fem/assembly.hpp"
#include "host/kinds/ground_loads.hpp"

namespace voussoir::host {

OpeningCheck check_opening(const Ground& ground, const GroundCase& soil, const K0Table& k0) {
  const fem::Mesh& mesh = ground.mesh;
  std::vector<fem::Stress> stress(static_cast<std::size_t>(mesh.n_points()));
  ground.material.committed(stress, {});
  const fem::GaussPoints points = fem::gauss_points(mesh, mesh.coordinates);
  const Eigen::VectorXd unbalanced = fem::internal_force(mesh, points, stress).force - ground_weight(mesh, soil, 1.0);
  const Eigen::VectorXd tractions = opening_tractions(mesh, soil, k0, 1.0);
  const fem::Constraints supports = ground_supports(mesh);

  OpeningCheck check;
  check.reactions = Eigen::VectorXd::Zero(mesh.n_dofs());
  for (const auto& [dof, value] : volume_loss_constraints(mesh, 0.0, 0.0)) check.reactions[dof] = unbalanced[dof];
  double difference = 0;
  double held = 0;
  for (const int node : mesh.node_set("opening")) {
    for (const int dof : {2 * node, 2 * node + 1}) {
      if (supports.contains(dof)) continue;  // crown and invert are also supported by the axis of symmetry
      difference += std::pow(unbalanced[dof] - tractions[dof], 2);
      held += std::pow(tractions[dof], 2);
    }
  }
  check.difference = std::sqrt(difference);
  check.relative = std::sqrt(difference / held);
  return check;
}

}  // namespace voussoir::host
