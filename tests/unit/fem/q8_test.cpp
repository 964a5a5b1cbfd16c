#include <gtest/gtest.h>

#include "fem/gauss_points.hpp"
#include "fem/mesh_rectangle.hpp"
#include "fem/q8.hpp"
#include "tests/fem_support.hpp"

namespace voussoir::fem {
namespace {

TEST(Q8, ShapeFunctionsAreOneAtTheirNode) {
  for (int node = 0; node < 8; ++node) {
    const q8::Shape n = q8::shape(q8::reference_nodes[node][0], q8::reference_nodes[node][1]);
    for (int a = 0; a < 8; ++a) EXPECT_NEAR(n[a], a == node ? 1 : 0, 1e-15);
  }
}

TEST(Q8, GradientsAreDerivativesOfTheShapeFunctions) {
  const double h = 1e-6;
  for (const double xi : {-0.83, 0.1, 0.57})
    for (const double eta : {-0.4, 0.9}) {
      const q8::ShapeGradient g = q8::shape_gradient(xi, eta);
      EXPECT_LT((g.col(0) - (q8::shape(xi + h, eta) - q8::shape(xi - h, eta)) / (2 * h)).norm(), 1e-9);
      EXPECT_LT((g.col(1) - (q8::shape(xi, eta + h) - q8::shape(xi, eta - h)) / (2 * h)).norm(), 1e-9);
      EXPECT_NEAR(q8::shape(xi, eta).sum(), 1, 1e-15);
      EXPECT_LT(g.colwise().sum().norm(), 1e-15);
    }
}

TEST(Q8, EdgeIsTheElementsTrace) {
  for (const double s : {-1.0, -0.3, 0.6, 1.0}) {
    const Eigen::Vector3d edge = q8::edge_shape(s);
    const q8::Shape element = q8::shape(s, -1);
    EXPECT_NEAR(edge[0], element[0], 1e-15);
    EXPECT_NEAR(edge[1], element[4], 1e-15);
    EXPECT_NEAR(edge[2], element[1], 1e-15);
  }
}

TEST(GaussPoints, LinearFieldHasItsGradientInCurvedElements) {
  const Mesh mesh = fem_support::distorted_rectangle(3, 2, 4, 3, 0.15);
  const GaussPoints points = gauss_points(mesh, mesh.coordinates);
  ASSERT_GT(points.smallest_jacobian, 0);
  Gradient expected;
  expected << 0.3, -0.1, 0.7, 0.2;
  Eigen::VectorXd u(mesh.n_dofs());
  u.reshaped(2, mesh.n_nodes()) = expected * mesh.coordinates;
  std::vector<Gradient> gradients;
  displacement_gradients(mesh, points, u, gradients);
  for (const Gradient& h : gradients) EXPECT_LT((h - expected).norm(), 1e-13);
  double area = 0;
  for (const double volume : points.volumes) area += volume;
  EXPECT_NEAR(area, 6, 1e-13);
}

TEST(GaussPoints, FoldedElementAndNotANumberAreSeen) {
  Mesh mesh = make_rectangle(2, 1, 2, 1);
  Coordinates folded = mesh.coordinates;
  folded(0, 1) = 3;
  EXPECT_LT(gauss_points(mesh, folded).smallest_jacobian, 0);
  folded = mesh.coordinates;
  folded(0, 0) = std::nan("");
  EXPECT_FALSE(gauss_points(mesh, folded).smallest_jacobian > 0);
}

}  // namespace
}  // namespace voussoir::fem
