#pragma once
/// The eight-node serendipity quadrilateral: shape functions, their gradients, 2x2 Gauss points, and the three-node
/// edge.
///
/// 2x2 points integrate the forces of a constant stress exactly, even in curved elements, because dN/dxi * dx/deta is
/// at most cubic in each variable. The patch test and the equilibrium of a constant stress with its edge tractions
/// therefore hold to rounding. The reduced rule has one spurious mode, which does not survive in a mesh of more than
/// one element.

#include <Eigen/Dense>
#include <array>

namespace voussoir::fem::q8 {

using Shape = Eigen::Matrix<double, 8, 1>;
using ShapeGradient = Eigen::Matrix<double, 8, 2>;  ///< row a: gradient of N_a

/// Corner and midside positions in the reference square [-1, 1]^2.
inline constexpr std::array<std::array<double, 2>, 8> reference_nodes{
    {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {0, -1}, {1, 0}, {0, 1}, {-1, 0}}};

inline constexpr double gauss_coordinate = 0.57735026918962576451;  ///< 1 / sqrt(3); every weight is 1

/// Gauss point p lies next to corner p.
inline constexpr std::array<std::array<double, 2>, 4> gauss_points{{{-gauss_coordinate, -gauss_coordinate},
                                                                    {gauss_coordinate, -gauss_coordinate},
                                                                    {gauss_coordinate, gauss_coordinate},
                                                                    {-gauss_coordinate, gauss_coordinate}}};

inline Shape shape(double xi, double eta) {
  Shape n;
  for (int a = 0; a < 4; ++a) {
    const double sx = xi * reference_nodes[a][0];
    const double sy = eta * reference_nodes[a][1];
    n[a] = 0.25 * (1 + sx) * (1 + sy) * (sx + sy - 1);
  }
  n[4] = 0.5 * (1 - xi * xi) * (1 - eta);
  n[5] = 0.5 * (1 + xi) * (1 - eta * eta);
  n[6] = 0.5 * (1 - xi * xi) * (1 + eta);
  n[7] = 0.5 * (1 - xi) * (1 - eta * eta);
  return n;
}

/// Gradients with respect to (xi, eta).
inline ShapeGradient shape_gradient(double xi, double eta) {
  ShapeGradient g;
  for (int a = 0; a < 4; ++a) {
    const double x = reference_nodes[a][0];
    const double y = reference_nodes[a][1];
    g(a, 0) = 0.25 * x * (1 + eta * y) * (2 * xi * x + eta * y);
    g(a, 1) = 0.25 * y * (1 + xi * x) * (2 * eta * y + xi * x);
  }
  g.row(4) << -xi * (1 - eta), -0.5 * (1 - xi * xi);
  g.row(5) << 0.5 * (1 - eta * eta), -eta * (1 + xi);
  g.row(6) << -xi * (1 + eta), 0.5 * (1 - xi * xi);
  g.row(7) << -0.5 * (1 - eta * eta), -eta * (1 - xi);
  return g;
}

/// Three Gauss points of a three-node edge, s in [-1, 1].
inline constexpr std::array<double, 3> edge_points{-0.77459666924148337704, 0.0, 0.77459666924148337704};
inline constexpr std::array<double, 3> edge_weights{5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};

/// Shape functions of the edge nodes in the order corner, mid, corner.
inline Eigen::Vector3d edge_shape(double s) { return {0.5 * s * (s - 1), 1 - s * s, 0.5 * s * (s + 1)}; }
inline Eigen::Vector3d edge_shape_derivative(double s) { return {s - 0.5, -2 * s, s + 0.5}; }

}  // namespace voussoir::fem::q8
