/// Kirsch's plate with a circular hole under uniaxial tension, plane strain: order of convergence of Q8 with 2x2
/// points.
#include <gtest/gtest.h>

#include "fem/mesh_rectangle.hpp"
#include "fem/newton.hpp"
#include "tests/constrain.hpp"
#include "tests/fem_support.hpp"

namespace voussoir::fem {
namespace {

constexpr double tension = 1e4;  ///< far stress along x [Pa]
constexpr double young = 1e7;    ///< [Pa]
constexpr double poisson = 0.3;
constexpr double inner = 1;  ///< radius of the hole [m]
constexpr double outer = 4;  ///< radius of the cut-out on which the exact tractions act [m]

Stress exact_stress(const Point& x) {
  const double c = inner * inner / x.squaredNorm();
  const double angle = std::atan2(x.y(), x.x());
  const double rr = 0.5 * tension * (1 - c + (1 - 4 * c + 3 * c * c) * std::cos(2 * angle));
  const double tt = 0.5 * tension * (1 + c - (1 + 3 * c * c) * std::cos(2 * angle));
  const double rt = -0.5 * tension * (1 + 2 * c - 3 * c * c) * std::sin(2 * angle);
  Eigen::Matrix2d polar;
  polar << rr, rt, rt, tt;
  const Eigen::Matrix2d q = Eigen::Rotation2Dd(angle).toRotationMatrix();
  const Eigen::Matrix2d s = q * polar * q.transpose();
  return {s(0, 0), s(1, 1), s(0, 1)};
}

/// Muskhelishvili, kappa = 3 - 4 nu.
Point exact_displacement(const Point& x) {
  const double mu = young / (2 * (1 + poisson));
  const double kappa = 3 - 4 * poisson;
  const double s = inner / x.norm();
  const double t = std::atan2(x.y(), x.x());
  const double factor = tension * inner / (8 * mu);
  return {factor * ((kappa + 1) / s * std::cos(t) + 2 * s * ((1 + kappa) * std::cos(t) + std::cos(3 * t)) -
                    2 * s * s * s * std::cos(3 * t)),
          factor * ((kappa - 3) / s * std::sin(t) + 2 * s * ((1 - kappa) * std::sin(t) + std::sin(3 * t)) -
                    2 * s * s * s * std::sin(3 * t))};
}

/// Quarter ring; "axis" of the unit square becomes the hole, "side" the outer arc, "base" y = 0, "top" x = 0.
Mesh quarter_ring(int n) {
  return fem_support::mapped(make_rectangle(1, 1, n, n), [](const Point& x) -> Point {
    const double r = inner * std::pow(outer / inner, x.x());
    const double angle = M_PI / 2 * x.y();
    return {x.y() == 1 ? 0 : r * std::cos(angle), r * std::sin(angle)};
  });
}

struct Errors {
  double displacement;  ///< relative L2 norm
  double energy;        ///< relative norm of the strain error in D
};

/// With 3x3 points, so that the better accuracy of the 2x2 points themselves is not mistaken for the order.
Errors errors_of(const Mesh& mesh, const Eigen::VectorXd& u) {
  const Tangent d = plane_strain_stiffness(young, poisson);
  double error_u = 0, norm_u = 0, error_e = 0, norm_e = 0;
  for (const ElementNodes& nodes : mesh.elements)
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) {
        const q8::Shape shape = q8::shape(q8::edge_points[i], q8::edge_points[j]);
        const q8::ShapeGradient gradient = q8::shape_gradient(q8::edge_points[i], q8::edge_points[j]);
        Eigen::Matrix2d jacobian = Eigen::Matrix2d::Zero(), du = Eigen::Matrix2d::Zero();
        Point x = Point::Zero(), value = Point::Zero();
        for (int a = 0; a < 8; ++a) {
          x += shape[a] * mesh.coordinates.col(nodes[a]);
          value += shape[a] * u.segment<2>(2 * nodes[a]);
          jacobian += mesh.coordinates.col(nodes[a]) * gradient.row(a);
          du += u.segment<2>(2 * nodes[a]) * gradient.row(a);
        }
        const double weight = q8::edge_weights[i] * q8::edge_weights[j] * jacobian.determinant();
        const Eigen::Vector3d strain = d.inverse() * exact_stress(x);
        const Eigen::Vector3d difference = strain_of(du * jacobian.inverse()) - strain;
        error_u += weight * (value - exact_displacement(x)).squaredNorm();
        norm_u += weight * exact_displacement(x).squaredNorm();
        error_e += weight * difference.dot(d * difference);
        norm_e += weight * strain.dot(d * strain);
      }
  return {std::sqrt(error_u / norm_u), std::sqrt(error_e / norm_e)};
}

Errors solve(int n) {
  const Mesh mesh = quarter_ring(n);
  LinearElastic material(static_cast<std::size_t>(mesh.n_points()), {.young = young, .poisson = poisson});
  NewtonSolver solver(mesh, material, Kinematics::fixed_mesh, {.tolerance = 1e-10, .initial_tangent_share = 0});
  const MeshState state = begin_stage(mesh, mesh.coordinates, material);
  IncrementLoad load{traction_force(mesh.coordinates, mesh.edge_set("side"), exact_stress), {}, 0, 0};
  constrain(load.prescribed, mesh.node_set("base"), 1, 0);
  constrain(load.prescribed, mesh.node_set("top"), 0, 0);
  Increment increment;
  const NewtonReport report = solver.solve_increment(state, load, increment);
  EXPECT_EQ(report.status, NewtonStatus::converged);
  return errors_of(mesh, increment.displacement);
}

TEST(Kirsch, DisplacementConvergesWithThirdOrderAndEnergyWithSecond) {
  Errors coarse = solve(4);
  for (const int n : {8, 16, 32}) {
    const Errors fine = solve(n);
    const double order_u = std::log2(coarse.displacement / fine.displacement);
    const double order_e = std::log2(coarse.energy / fine.energy);
    std::printf("%2d x %2d elements: |u error| %.2e (order %.2f), energy %.2e (order %.2f)\n", n, n, fine.displacement,
                order_u, fine.energy, order_e);
    if (n > 8) {
      EXPECT_GT(order_u, 2.95);
      EXPECT_GT(order_e, 1.97);
    }
    coarse = fine;
  }
  EXPECT_LT(coarse.displacement, 2e-6);
  EXPECT_LT(coarse.energy, 4e-4);
}

}  // namespace
}  // namespace voussoir::fem
