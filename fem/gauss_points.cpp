#include "fem/gauss_points.hpp"

#include <algorithm>
#include <limits>

namespace voussoir::fem {

namespace {

struct ReferencePoint {
  q8::Shape shape;
  q8::ShapeGradient gradient;
};

const std::array<ReferencePoint, 4>& reference_points() {
  static const auto points = [] {
    std::array<ReferencePoint, 4> result;
    for (int p = 0; p < 4; ++p) {
      const auto [xi, eta] = q8::gauss_points[p];
      result[p] = {q8::shape(xi, eta), q8::shape_gradient(xi, eta)};
    }
    return result;
  }();
  return points;
}

}  // namespace

GaussPoints gauss_points(const Mesh& mesh, const Coordinates& coordinates) {
  GaussPoints points;
  points.gradients.resize(mesh.n_points());
  points.volumes.resize(mesh.n_points());
  points.positions.resize(2, mesh.n_points());
  points.smallest_jacobian = std::numeric_limits<double>::infinity();
  Eigen::Matrix<double, 2, 8> x;
  for (int e = 0; e < mesh.n_elements(); ++e) {
    for (int a = 0; a < 8; ++a) x.col(a) = coordinates.col(mesh.elements[e][a]);
    for (int p = 0; p < 4; ++p) {
      const ReferencePoint& reference = reference_points()[p];
      points.positions.col(4 * e + p) = x * reference.shape;
      if (mesh.is_dug_out(e)) {
        points.gradients[4 * e + p].setZero();
        points.volumes[4 * e + p] = 0;
        continue;
      }
      const Eigen::Matrix2d jacobian = x * reference.gradient;  // J_ij = dx_i / dxi_j
      const double det = jacobian.determinant();
      points.gradients[4 * e + p] = reference.gradient * jacobian.inverse();
      points.volumes[4 * e + p] = det;
      points.smallest_jacobian = det < points.smallest_jacobian || !(det == det) ? det : points.smallest_jacobian;
    }
  }
  return points;
}

void displacement_gradients(const Mesh& mesh, const GaussPoints& points, const Eigen::VectorXd& u,
                            std::vector<Gradient>& gradients) {
  gradients.resize(mesh.n_points());
  Eigen::Matrix<double, 2, 8> element;
  for (int e = 0; e < mesh.n_elements(); ++e) {
    for (int a = 0; a < 8; ++a) element.col(a) = u.segment<2>(2 * mesh.elements[e][a]);
    for (int p = 0; p < 4; ++p) gradients[4 * e + p].noalias() = element * points.gradients[4 * e + p];
  }
}

}  // namespace voussoir::fem
