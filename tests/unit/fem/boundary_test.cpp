#include <gtest/gtest.h>

#include "fem/assembly.hpp"
#include "fem/boundary.hpp"
#include "fem/mesh_rectangle.hpp"
#include "fem/mesh_tunnel.hpp"
#include "tests/constrain.hpp"
#include "tests/fem_support.hpp"
#include "tests/shrinking_opening.hpp"
#include "tests/throws.hpp"

namespace voussoir::fem {
namespace {

Point resultant(const Eigen::VectorXd& f) { return f.reshaped(2, f.size() / 2).rowwise().sum(); }

TEST(Boundary, PressureOnTheTopPushesDown) {
  const Mesh mesh = make_rectangle(4, 2, 3, 2);
  const Point f = resultant(pressure_force(mesh.coordinates, mesh.edge_set("top"), 1000));
  EXPECT_NEAR(f.x(), 0, 1e-9);
  EXPECT_NEAR(f.y(), -4000, 1e-9);
}

TEST(Boundary, WeightIsTheAreaTimesUnitWeight) {
  const Mesh mesh = make_half_tunnel({});
  const double hole = -area_left_of(mesh.coordinates, mesh.edge_set("opening"));
  const Point f = resultant(body_force(mesh, mesh.coordinates, {0, -2e4}));
  EXPECT_NEAR(f.y(), -2e4 * (35 * 35 - hole), 1e-6);
  EXPECT_EQ(f.x(), 0);
}

TEST(Boundary, OpeningTractionsHaveTheExactResultant) {
  const Mesh mesh = make_half_tunnel({.cover = 15, .size_near = 0.9, .size_far = 3});
  const double gamma = 2e4, height = 35, surcharge = 1e3, lambda = 0.7, k0 = 0.45;
  const GeostaticStress field{{{0, gamma}}, height, surcharge, lambda, [=](std::size_t, double) { return k0; }};
  const Point f = resultant(traction_force(mesh.coordinates, mesh.edge_set("opening"), field));
  // Divergence theorem on the half hole (N points into it), closed by its chord on the axis.
  const double hole = -area_left_of(mesh.coordinates, mesh.edge_set("opening"));
  EXPECT_NEAR(f.y(), -lambda * gamma * hole, 1e-13 * gamma * hole);
  const double depth_of_axis = 15 + 2.5;
  const double chord = -k0 * 5 * (lambda * gamma * depth_of_axis + surcharge);  // integral of s_xx over the chord
  EXPECT_NEAR(f.x(), -chord, 1e-13 * std::abs(chord));
}

TEST(Boundary, IsotropicStressIsInEquilibriumAtLoadFactorZero) {
  const Mesh mesh = make_half_tunnel({});
  const GeostaticStress field{{{0, 2e4}}, 35, 1e3, 0, [](std::size_t, double) { return 1.0; }};
  const Eigen::VectorXd force = traction_force(mesh.coordinates, mesh.edge_set("opening"), field) +
                                pressure_force(mesh.coordinates, mesh.edge_set("top"), 1e3);
  const InternalForce internal = internal_force(mesh, gauss_points(mesh, mesh.coordinates),
                                                std::vector<Stress>(mesh.n_points(), Stress(-1e3, -1e3, 0)));
  Constraints supports;
  constrain(supports, mesh.node_set("base"), 1, 0);
  constrain(supports, mesh.node_set("axis"), 0, 0);
  constrain(supports, mesh.node_set("side"), 0, 0);
  Eigen::VectorXd residual = force - internal.force;
  for (const auto& [dof, value] : supports) residual[dof] = 0;
  EXPECT_LT(residual.norm(), 1e-12 * force.norm());
}

TEST(VolumeLoss, RemovesExactlyItsShareOfTheArea) {
  const Mesh mesh = make_half_tunnel({});
  const double before = area_left_of(mesh.coordinates, mesh.edge_set("opening"));
  EXPECT_NEAR(-before, M_PI * 25 / 8, 5e-5);  // Q8 edges against the circle
  Coordinates moved = mesh.coordinates;
  double reached = 0;
  for (int k = 1; k <= 80; ++k) {  // the sum of increments, each on the original coordinates
    Constraints increment;
    shrink_opening(increment, mesh, reached, 0.0025 * k);
    reached = 0.0025 * k;
    for (const auto& [dof, value] : increment) moved(dof % 2, dof / 2) += value;
  }
  EXPECT_NEAR(area_left_of(moved, mesh.edge_set("opening")) / before, 0.8, 1e-13);
  const int crown = mesh.point("crown");
  const int invert = mesh.point("invert");
  EXPECT_NEAR(mesh.coordinates(1, crown) - moved(1, crown), 5 * (1 - std::sqrt(0.8)), 1e-13);  // 0.528 m
  EXPECT_EQ(moved.col(invert), mesh.coordinates.col(invert));
  EXPECT_EQ(moved(0, crown), 0);
}

TEST(AffineMotion, CannotTakeAllOfTheArea) {
  expect_throws<std::invalid_argument>([&] { static_cast<void>(affine_displacement({1, 1}, {0, 0}, 0, -1)); },
                                       "the area must not vanish");
}

TEST(AffineMotion, TurnsAndScalesAboutItsCentre) {
  const Point centre(1, 2), x(3, 2);
  const Point moved = x + affine_displacement(x, centre, M_PI / 2, 0.44);  // area + 44 %: lengths times 1.2
  EXPECT_NEAR(moved.x(), 1, 1e-15);
  EXPECT_NEAR(moved.y(), 2 + 1.2 * 2, 1e-15);
}

}  // namespace
}  // namespace voussoir::fem
