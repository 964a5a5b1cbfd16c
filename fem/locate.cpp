#include "fem/locate.hpp"

#include <algorithm>
#include <cmath>

#include "fem/q8.hpp"

namespace voussoir::fem {
namespace {

constexpr double outside = 1e-6;  ///< of the reference square

std::optional<Located> locate_in(const Eigen::Matrix<double, 2, 8>& nodes, const Point& x) {
  Point at = Point::Zero();
  for (int iteration = 0; iteration < 30; ++iteration) {
    const Point miss = x - nodes * q8::shape(at.x(), at.y());
    const Point step = (nodes * q8::shape_gradient(at.x(), at.y())).inverse() * miss;
    if (!step.allFinite()) return {};
    at += step;
    if (at.cwiseAbs().maxCoeff() > 10) return {};
    if (step.norm() < 1e-13) break;
  }
  // An iteration that did not converge has found nothing.
  const double size = (nodes.rowwise().maxCoeff() - nodes.rowwise().minCoeff()).norm();
  if ((x - nodes * q8::shape(at.x(), at.y())).norm() > 1e-9 * size + 1e-12 * x.norm()) return {};
  if (at.cwiseAbs().maxCoeff() > 1 + outside) return {};
  at = at.cwiseMax(-1.0).cwiseMin(1.0);
  return Located{0, at.x(), at.y()};
}

}  // namespace

std::optional<Located> locate(const Mesh& mesh, const Coordinates& coordinates, const Point& x,
                              std::span<const int> rank) {
  std::optional<Located> best;
  Eigen::Matrix<double, 2, 8> nodes;
  for (int e = 0; e < mesh.n_elements(); ++e) {
    for (int a = 0; a < 8; ++a) nodes.col(a) = coordinates.col(mesh.elements[e][a]);
    const Point low = nodes.rowwise().minCoeff(), high = nodes.rowwise().maxCoeff();
    const Point margin = 0.05 * (high - low);  // midsides may bulge between nodes
    if ((x - low + margin).minCoeff() < 0 || (high - x + margin).minCoeff() < 0) continue;
    if (best && rank[e] >= rank[best->element]) continue;
    if (std::optional<Located> found = locate_in(nodes, x)) {
      found->element = e;
      if (rank.empty()) return found;
      best = found;
    }
  }
  return best;
}

Point value_at(const Mesh& mesh, const Located& at, const Eigen::VectorXd& field) {
  const q8::Shape shape = q8::shape(at.xi, at.eta);
  Point value = Point::Zero();
  for (int a = 0; a < 8; ++a) value += shape[a] * field.segment<2>(2 * mesh.elements[at.element][a]);
  return value;
}

int nearest_gauss_point(const Located& at) {
  const int right = at.xi > 0 ? 1 : 0;
  const int corner = at.eta > 0 ? 3 - right : right;
  return 4 * at.element + corner;
}

}  // namespace voussoir::fem
