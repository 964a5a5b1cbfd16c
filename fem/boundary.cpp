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

void constrain(Constraints& constraints, const std::vector<int>& nodes, int axis, double value) {
  for (const int node : nodes) {
    const auto [entry, is_new] = constraints.try_emplace(2 * node + axis, value);
    if (!is_new && entry->second != value)
      throw std::invalid_argument("boundary: node " + std::to_string(node) + " is given two displacements on one axis");
  }
}

Point volume_loss_displacement(const Point& x, const Point& invert, double volume_loss) {
  if (!(volume_loss >= 0 && volume_loss < 1)) throw std::invalid_argument("boundary: volume loss must be in [0, 1)");
  return (std::sqrt(1 - volume_loss) - 1) * (x - invert);
}

void constrain_volume_loss(Constraints& constraints, const Mesh& mesh, double from, double to) {
  const Point invert = mesh.coordinates.col(mesh.point("invert"));
  for (const int node : mesh.node_set("opening")) {
    const Point x = mesh.coordinates.col(node);
    const Point u = volume_loss_displacement(x, invert, to) - volume_loss_displacement(x, invert, from);
    constrain(constraints, {node}, 0, u.x());
    constrain(constraints, {node}, 1, u.y());
  }
}

Eigen::VectorXd body_force(const Mesh& mesh, const Coordinates& coordinates, const Point& b) {
  const GaussPoints points = gauss_points(mesh, coordinates);
  Eigen::VectorXd f = Eigen::VectorXd::Zero(mesh.n_dofs());
  for (int i = 0; i < mesh.n_points(); ++i) {
    const auto [xi, eta] = q8::gauss_points[i % 4];
    const q8::Shape shape = q8::shape(xi, eta);
    for (int a = 0; a < 8; ++a) f.segment<2>(2 * mesh.elements[i / 4][a]) += shape[a] * points.volumes[i] * b;
  }
  return f;
}

Eigen::VectorXd pressure_force(const Coordinates& coordinates, const std::vector<Edge>& edges, double p) {
  return integrate_edges(coordinates, edges, [p](const Point&, const Point& n) -> Point { return -p * n; });
}

Eigen::VectorXd traction_force(const Coordinates& coordinates, const std::vector<Edge>& edges,
                               const StressField& field) {
  return integrate_edges(coordinates, edges, [&field](const Point& x, const Point& n) -> Point {
    const Stress s = field(x);
    return {s[0] * n.x() + s[2] * n.y(), s[2] * n.x() + s[1] * n.y()};
  });
}

Stress GeostaticStress::operator()(const Point& x) const {
  const double vertical = -(load_factor * unit_weight * (height - x.y()) + surcharge);
  return {k0(vertical) * vertical, vertical, 0};
}

}  // namespace voussoir::fem
