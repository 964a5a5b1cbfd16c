#include "fem/recovery.hpp"

namespace voussoir::fem {

Eigen::MatrixXd element_means(const GaussPoints& points, const Eigen::MatrixXd& values) {
  Eigen::MatrixXd means = Eigen::MatrixXd::Zero(values.rows(), values.cols() / 4);
  for (Eigen::Index e = 0; e < means.cols(); ++e) {
    double volume = 0;
    for (Eigen::Index i = 4 * e; i < 4 * e + 4; ++i) {
      means.col(e) += points.volumes[i] * values.col(i);
      volume += points.volumes[i];
    }
    means.col(e) /= volume;
  }
  return means;
}

Eigen::MatrixXd nodal_values(const Mesh& mesh, const GaussPoints& points, const Eigen::MatrixXd& values) {
  // Row a: weights of the four points at node a, the bilinear functions of the square through the points.
  Eigen::Matrix<double, 8, 4> weights;
  for (int a = 0; a < 8; ++a)
    for (int p = 0; p < 4; ++p) {
      const double sx = 3 * q8::reference_nodes[a][0] * q8::gauss_points[p][0];
      const double sy = 3 * q8::reference_nodes[a][1] * q8::gauss_points[p][1];
      weights(a, p) = 0.25 * (1 + sx) * (1 + sy);
    }
  Eigen::MatrixXd nodal = Eigen::MatrixXd::Zero(values.rows(), mesh.n_nodes());
  Eigen::VectorXd volumes = Eigen::VectorXd::Zero(mesh.n_nodes());
  for (int e = 0; e < mesh.n_elements(); ++e) {
    const double volume =
        points.volumes[4 * e] + points.volumes[4 * e + 1] + points.volumes[4 * e + 2] + points.volumes[4 * e + 3];
    const Eigen::MatrixXd at_nodes = values.middleCols(4 * e, 4) * weights.transpose();
    for (int a = 0; a < 8; ++a) {
      nodal.col(mesh.elements[e][a]) += volume * at_nodes.col(a);
      volumes[mesh.elements[e][a]] += volume;
    }
  }
  return nodal * volumes.cwiseInverse().asDiagonal();
}

}  // namespace voussoir::fem
