#include "host/kinds/opening_check.hpp"

#include <cmath>
#include <vector>

namespace voussoir::host {

OpeningCheck check_opening(const fem::Mesh& mesh, const StagePlan& before, const Eigen::VectorXd& reactions,
                           const Eigen::VectorXd& tractions) {
  double difference = 0;
  double held = 0;
  for (const int node : mesh.node_set("opening")) {
    for (const int dof : {2 * node, 2 * node + 1}) {
      if (before.owners.contains(dof)) continue;  // crown and invert are also supported by the axis of symmetry
      difference += std::pow(reactions[dof] - tractions[dof], 2);
      held += std::pow(tractions[dof], 2);
    }
  }
  return {.difference = std::sqrt(difference), .relative = std::sqrt(difference / held)};
}

}  // namespace voussoir::host
