#include <gtest/gtest.h>

#include <random>

#include "fem/newton.hpp"
#include "fem/noise.hpp"
#include "tests/fem_support.hpp"

namespace voussoir::fem {
namespace {

Eigen::MatrixXd dense(const SparsePattern& pattern, const std::vector<double>& values) {
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(pattern.n, pattern.n);
  for (int column = 0; column < pattern.n; ++column)
    for (int i = pattern.column_start[column]; i < pattern.column_start[column + 1]; ++i)
      k(pattern.row[i], column) = k(column, pattern.row[i]) = values[i];
  return k;
}

struct Problem {
  Mesh mesh = fem_support::distorted_rectangle(2, 2, 3, 2, 0.1);
  GaussPoints points = gauss_points(mesh, mesh.coordinates);
  std::vector<Tangent> tangents;
  std::vector<char> none = std::vector<char>(mesh.n_dofs(), 0);
  Problem() {
    for (int i = 0; i < mesh.n_points(); ++i) tangents.push_back(plane_strain_stiffness(1e6 * (1 + i % 5), 0.2));
  }
};

TEST(Assembly, StiffnessIsTheDerivativeOfTheInternalForce) {
  const Problem p;
  const StiffnessAssembler assembler(p.mesh);
  const Eigen::MatrixXd k = dense(assembler.pattern(), assembler.assemble(p.points, p.tangents, p.none));
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const Eigen::VectorXd u = Eigen::VectorXd::NullaryExpr(p.mesh.n_dofs(), [&] { return 1e-3 * normal(random); });
  std::vector<Gradient> h;
  displacement_gradients(p.mesh, p.points, u, h);
  std::vector<Stress> stress;
  for (int i = 0; i < p.mesh.n_points(); ++i) stress.push_back(p.tangents[i] * strain_of(h[i]));
  const Eigen::VectorXd f = internal_force(p.mesh, p.points, stress).force;
  EXPECT_LT((k * u - f).norm(), 1e-13 * f.norm());  // the law is linear: no finite difference is needed
}

TEST(SparseSolver, SolvesAndReportsWhatIsNotPositiveDefinite) {
  Problem p;
  const StiffnessAssembler assembler(p.mesh);
  SparseSolver solver(assembler.pattern());
  std::vector<char> fixed = p.none;
  for (const int node : p.mesh.node_set("base")) fixed[2 * node] = fixed[2 * node + 1] = 1;
  const std::vector<double> values = assembler.assemble(p.points, p.tangents, fixed);
  ASSERT_EQ(solver.factorise(values), FactorStatus::ok);
  const Eigen::MatrixXd right = Eigen::MatrixXd::Random(p.mesh.n_dofs(), 3);
  EXPECT_LT((dense(assembler.pattern(), values) * solver.solve(right) - right).norm(), 1e-11 * right.norm());

  for (int i = 4; i < 8; ++i) p.tangents[i] *= -3;  // one element
  EXPECT_EQ(solver.factorise(assembler.assemble(p.points, p.tangents, fixed)), FactorStatus::not_positive_definite);
  for (int i = 4; i < 8; ++i) p.tangents[i] /= -3;
  EXPECT_EQ(solver.factorise(assembler.assemble(p.points, p.tangents, fixed)), FactorStatus::ok);
}

TEST(NoiseForce, IsTheMeanNormOfIndependentStressErrors) {
  const Problem p;
  std::vector<char> fixed = p.none;
  for (const int node : p.mesh.node_set("base")) fixed[2 * node] = fixed[2 * node + 1] = 1;
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0, 100);
  double sum = 0;
  constexpr int samples = 2000;
  for (int k = 0; k < samples; ++k) {
    std::vector<Stress> errors(p.mesh.n_points());
    for (Stress& e : errors) e = Stress(normal(random), normal(random), normal(random));
    const Eigen::VectorXd f = internal_force(p.mesh, p.points, errors).force;
    for (int dof = 0; dof < p.mesh.n_dofs(); ++dof) sum += fixed[dof] ? 0 : f[dof] * f[dof];
  }
  const double expected = noise_force(p.mesh, p.points, fixed, 100);
  EXPECT_NEAR(std::sqrt(sum / samples), expected, 0.005 * expected);
}

}  // namespace
}  // namespace voussoir::fem
