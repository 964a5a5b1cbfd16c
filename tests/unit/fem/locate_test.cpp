// The element at a place: on nodes, in distorted and curved elements, at edges, outside.
#include "fem/locate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "fem/mesh_grid.hpp"
#include "fem/q8.hpp"
#include "tests/fem_support.hpp"

namespace voussoir::fem {
namespace {

Point place_of(const Mesh& mesh, const Located& at) {
  const q8::Shape shape = q8::shape(at.xi, at.eta);
  Point x = Point::Zero();
  for (int a = 0; a < 8; ++a) x += shape[a] * mesh.coordinates.col(mesh.elements[at.element][a]);
  return x;
}

/// Every place of every element is found again, in this element or at a shared edge.
void expect_found(const Mesh& mesh, double size) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int e = 0; e < mesh.n_elements(); ++e) {
    for (int k = 0; k < 50; ++k) {
      Located at{e, uniform(random), uniform(random)};
      if (k % 5 == 0) at.xi = k % 2 == 0 ? 1 : -1;
      const Point x = place_of(mesh, at);
      const auto found = locate(mesh, mesh.coordinates, x);
      ASSERT_TRUE(found) << e << " " << at.xi << " " << at.eta;
      EXPECT_LT((place_of(mesh, *found) - x).norm(), 1e-6 * size);
    }
  }
}

TEST(Locate, InDistortedAndCurvedElements) {
  expect_found(fem_support::distorted_rectangle(4, 2, 4, 3, 0.15), 1);
  expect_found(make_ring({.radius = 1, .outer = 6, .columns = 4, .rows = 3, .ratio = 1.5, .quarters = 4}), 1);
  // Far from the origin, where coordinates have few digits left.
  expect_found(fem_support::mapped(fem_support::distorted_rectangle(4, 2, 4, 3, 0.15),
                                   [](const Point& x) -> Point { return {x.x() + 5e6, x.y() - 3e6}; }),
               1e-2);
  expect_found(fem_support::mapped(make_rectangle(1, 1, 3, 3),
                                   [](const Point& x) -> Point { return {x.x() + 2 * x.y(), 1e-3 * x.y()}; }),
               1e-3);
}

TEST(Locate, NodesAndOutside) {
  const Mesh ring = make_ring({.radius = 1, .outer = 6, .columns = 4, .rows = 3, .quarters = 1});
  for (int node = 0; node < ring.n_nodes(); ++node) {
    const auto found = locate(ring, ring.coordinates, ring.coordinates.col(node));
    ASSERT_TRUE(found);
    EXPECT_LT((place_of(ring, *found) - Point(ring.coordinates.col(node))).norm(), 1e-9);
  }
  for (const Point& x : {Point(0.5, 0.5), Point(6, 6), Point(-0.1, 3), Point(0.69, 0.69), Point(NAN, 2)})
    EXPECT_FALSE(locate(ring, ring.coordinates, x)) << x.transpose();
  // In the bulge of a curved edge beyond the chord of its corners.
  const double angle = M_PI / 16;
  const Point bulge(5.9999 * std::cos(angle), 5.9999 * std::sin(angle));
  EXPECT_TRUE(locate(ring, ring.coordinates, bulge));
}

TEST(Locate, OfElementsThatMeetTheLowestRankCounts) {
  const Mesh mesh = make_rectangle(2, 1, 2, 1);
  const Point between(1, 0.3);
  EXPECT_EQ(locate(mesh, mesh.coordinates, between)->element, 0);
  const std::array<int, 2> rank{2, 1};
  EXPECT_EQ(locate(mesh, mesh.coordinates, between, rank)->element, 1);
}

TEST(Locate, ValuesOfALinearField) {
  const Mesh mesh = fem_support::distorted_rectangle(4, 2, 4, 3, 0.1);
  Eigen::VectorXd field(mesh.n_dofs());
  const auto linear = [](const Point& x) -> Point { return {1 + 2 * x.x() - x.y(), 3 * x.y()}; };
  for (int node = 0; node < mesh.n_nodes(); ++node) field.segment<2>(2 * node) = linear(mesh.coordinates.col(node));
  for (const Point& x : {Point(0.3, 0.4), Point(2.2, 1.9), Point(4, 2)})
    EXPECT_LT((value_at(mesh, *locate(mesh, mesh.coordinates, x), field) - linear(x)).norm(), 1e-9);
}

TEST(Locate, TheNearestGaussPoint) {
  for (int p = 0; p < 4; ++p) {
    const auto [xi, eta] = q8::gauss_points[static_cast<std::size_t>(p)];
    EXPECT_EQ(nearest_gauss_point({3, xi, eta}), 12 + p);
  }
}

}  // namespace
}  // namespace voussoir::fem
