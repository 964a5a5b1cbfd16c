#include "fem/noise.hpp"

#include <cmath>
#include <random>

#include "fem/assembly.hpp"

namespace voussoir::fem {

double noise_force(const Mesh& mesh, const GaussPoints& points, const std::vector<char>& constrained,
                   double stress_noise) {
  double sum = 0;
  for (int i = 0; i < mesh.n_points(); ++i)
    for (int a = 0; a < 8; ++a) {
      const int node = mesh.elements[i / 4][a];
      const int free_dofs = 2 - (constrained[2 * node] != 0) - (constrained[2 * node + 1] != 0);
      sum += points.volumes[i] * points.volumes[i] * free_dofs * points.gradients[i].row(a).squaredNorm();
    }
  return stress_noise * std::sqrt(sum);
}

Eigen::VectorXd unit_noise_sample(const Mesh& mesh, const GaussPoints& points, const std::vector<char>& constrained) {
  std::minstd_rand random(1);  // its sequence is the same everywhere
  const auto sign = [&random] { return random() % 4096 < 2048 ? -1.0 : 1.0; };
  std::vector<Stress> errors(mesh.n_points());
  for (Stress& error : errors)
    for (double& component : error) component = sign();
  Eigen::VectorXd force = internal_force(mesh, points, errors).force;
  for (int dof = 0; dof < mesh.n_dofs(); ++dof)
    if (constrained[dof]) force[dof] = 0;
  return force;
}

}  // namespace voussoir::fem
