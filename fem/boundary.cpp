#include "fem/boundary.hpp"

#include <cmath>
#include <stdexcept>

#include "fem/gauss_points.hpp"

namespace voussoir::fem {

namespace {

/// Consistent nodal forces of a traction. At each point of an edge `force(x, n)` returns the traction times ds; its
/// arguments are the position and the outward normal times ds, which is the tangent turned clockwise, since the soil is
/// on the left.
template <class Force>
Eigen::VectorXd integrate_edges(const Coordinates& coordinates, const std::vector<Edge>& edges, const Force& force) {
  Eigen::VectorXd f = Eigen::VectorXd::Zero(2 * coordinates.cols());
  for (const Edge& edge : edges)
    for (std::size_t q = 0; q < q8::edge_points.size(); ++q) {
      const Eigen::Vector3d shape = q8::edge_shape(q8::edge_points[q]);
      const Eigen::Vector3d derivative = q8::edge_shape_derivative(q8::edge_points[q]);
      Point x = Point::Zero();
      Point tangent = Point::Zero();
      for (int k = 0; k < 3; ++k) {
        x += shape[k] * coordinates.col(edge[k]);
        tangent += derivative[k] * coordinates.col(edge[k]);
      }
      const Point t = q8::edge_weights[q] * force(x, Point(tangent.y(), -tangent.x()));
      for (int k = 0; k < 3; ++k) f.segment<2>(2 * edge[k]) += shape[k] * t;
    }
  return f;
}

}  // namespace

Point affine_displacement(const Point& x, const Point& centre, double rotation, double area) {
  if (!(area > -1)) throw std::invalid_argument("boundary: the area must not vanish");
  const double scale = std::sqrt(1 + area);
  const Point from_centre = x - centre;
  if (rotation == 0) return (scale - 1) * from_centre;
  const double c = scale * std::cos(rotation), s = scale * std::sin(rotation);
  return {(c - 1) * from_centre.x() - s * from_centre.y(), s * from_centre.x() + (c - 1) * from_centre.y()};
}

Eigen::VectorXd body_force(const Mesh& mesh, const Coordinates& coordinates, const Point& b) {
  return body_force(mesh, coordinates, std::vector<Point>(static_cast<std::size_t>(mesh.n_elements()), b));
}

Eigen::VectorXd body_force(const Mesh& mesh, const Coordinates& coordinates, std::span<const Point> b) {
  const GaussPoints points = gauss_points(mesh, coordinates);
  Eigen::VectorXd f = Eigen::VectorXd::Zero(mesh.n_dofs());
  for (int i = 0; i < mesh.n_points(); ++i) {
    const auto [xi, eta] = q8::gauss_points[i % 4];
    const q8::Shape shape = q8::shape(xi, eta);
    for (int a = 0; a < 8; ++a) f.segment<2>(2 * mesh.elements[i / 4][a]) += shape[a] * points.volumes[i] * b[i / 4];
  }
  return f;
}

Eigen::VectorXd pressure_force(const Coordinates& coordinates, const std::vector<Edge>& edges, double p) {
  return integrate_edges(coordinates, edges, [p](const Point&, const Point& n) -> Point { return -p * n; });
}

Eigen::VectorXd constant_traction_force(const Coordinates& coordinates, const std::vector<Edge>& edges,
                                        const Point& traction) {
  return integrate_edges(coordinates, edges,
                         [&traction](const Point&, const Point& n) -> Point { return n.norm() * traction; });
}

Eigen::VectorXd traction_force(const Coordinates& coordinates, const std::vector<Edge>& edges,
                               const StressField& field) {
  return integrate_edges(coordinates, edges, [&field](const Point& x, const Point& n) -> Point {
    const Stress s = field(x);
    return {s[0] * n.x() + s[2] * n.y(), s[2] * n.x() + s[1] * n.y()};
  });
}

Stress GeostaticStress::operator()(const Point& x) const {
  double overburden = 0;
  double top = height;
  std::size_t at = 0;
  for (;; ++at) {
    const bool last = at + 1 == layers.size() || x.y() >= layers[at].bottom;
    overburden += load_factor * layers[at].unit_weight * (top - (last ? x.y() : layers[at].bottom));
    if (last) break;
    top = layers[at].bottom;
  }
  const double vertical = -(overburden + surcharge);
  return {k0(at, vertical) * vertical, vertical, 0};
}

}  // namespace voussoir::fem
