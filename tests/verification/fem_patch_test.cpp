/// Patch tests: a constant stress state is reproduced exactly on distorted and curved elements, in both geometries, and
/// a rigid rotation turns it and does nothing else.
#include <gtest/gtest.h>

#include "fem/newton.hpp"
#include "tests/constrain.hpp"
#include "tests/fem_support.hpp"

namespace voussoir::fem {
namespace {

constexpr NewtonOptions exact{.tolerance = 1e-11, .displacement_tolerance = 1e-9, .initial_tangent_share = 0};

Gradient patch_gradient() {
  Gradient h;
  h << 1e-3, -4e-4, 7e-4, -2e-3;
  return h;
}

double largest_difference(const std::vector<Stress>& stress, const Stress& expected) {
  double largest = 0;
  for (const Stress& s : stress) largest = std::max(largest, (s - expected).cwiseAbs().maxCoeff());
  return largest;
}

TEST(Patch, LinearDisplacementOnTheOutline) {
  const Mesh mesh = fem_support::distorted_rectangle(2, 1.5, 4, 3, 0.12);
  for (const Kinematics kinematics : {Kinematics::updated_lagrangian, Kinematics::fixed_mesh}) {
    LinearElastic material(static_cast<std::size_t>(mesh.n_points()), {});
    NewtonSolver solver(mesh, material, kinematics, exact);
    const MeshState state = begin_stage(mesh, mesh.coordinates, material);
    IncrementLoad load{Eigen::VectorXd::Zero(mesh.n_dofs()), {}, 0, 0};
    for (const int node : fem_support::outline(mesh))
      for (const int axis : {0, 1})
        constrain(load.prescribed, {node}, axis, (patch_gradient() * mesh.coordinates.col(node))[axis]);
    Increment increment;
    const NewtonReport report = solver.solve_increment(state, load, increment);
    ASSERT_EQ(report.status, NewtonStatus::converged);
    EXPECT_EQ(report.iterations, 1);
    const Stress expected = plane_strain_stiffness(1e7, 0.3) * strain_of(patch_gradient());
    EXPECT_LT(largest_difference(increment.stress, expected), 1e-12 * expected.norm());
    const Eigen::MatrixXd u = patch_gradient() * mesh.coordinates;
    EXPECT_LT((increment.displacement - u.reshaped()).norm(), 1e-13 * u.norm());
  }
}

TEST(Patch, ConstantTractionsOnTheOutline) {
  const Mesh mesh = fem_support::distorted_rectangle(2, 1.5, 4, 3, 0.12);
  LinearElastic material(static_cast<std::size_t>(mesh.n_points()), {});
  NewtonSolver solver(mesh, material, Kinematics::fixed_mesh, exact);
  const MeshState state = begin_stage(mesh, mesh.coordinates, material);
  const Stress stress(-4e3, -9e3, 2e3);
  IncrementLoad load{Eigen::VectorXd::Zero(mesh.n_dofs()), {}, 0, 0};
  for (const auto& [name, chain] : mesh.edges)
    load.external_force += traction_force(mesh.coordinates, chain,
                                          [&](const Point&) -> Stress { return Stress(stress); });
  const int corner = mesh.node_set("base").front();  // no more supports than a rigid body needs
  constrain(load.prescribed, {corner}, 0, 0);
  constrain(load.prescribed, {corner}, 1, 0);
  constrain(load.prescribed, {mesh.node_set("base").back()}, 1, 0);
  Increment increment;
  ASSERT_EQ(solver.solve_increment(state, load, increment).status, NewtonStatus::converged);
  EXPECT_LT(largest_difference(increment.stress, stress), 1e-11 * stress.norm());
  EXPECT_LT(increment.reactions.norm(), 1e-12 * load.external_force.norm());
}

TEST(Patch, RigidRotationTurnsTheStressAndNothingElse) {
  const Mesh mesh = fem_support::distorted_rectangle(2, 1.5, 4, 3, 0.12);
  Eigen::Matrix2d start;
  start << -3e4, 1e4, 1e4, -1e5;
  for (const Kinematics kinematics : {Kinematics::updated_lagrangian, Kinematics::fixed_mesh}) {
    LinearElastic material(
        static_cast<std::size_t>(mesh.n_points()),
        {.initial_stress = Stress(start(0, 0), start(1, 1), start(0, 1)), .strain = ElasticStrain::logarithmic});
    NewtonSolver solver(mesh, material, kinematics, {.tolerance = 1e-10, .displacement_tolerance = 1e-9});
    MeshState state = begin_stage(mesh, mesh.coordinates, material);
    Increment increment;
    constexpr int steps = 6;
    for (int k = 1; k <= steps; ++k) {  // 90 degrees in all
      const double angle = M_PI / 2 / steps;
      const Eigen::Matrix2d turned = Eigen::Rotation2Dd(k * angle).toRotationMatrix();
      const Eigen::Matrix2d before = Eigen::Rotation2Dd((k - 1) * angle).toRotationMatrix();
      IncrementLoad load{Eigen::VectorXd::Zero(mesh.n_dofs()), {}, 0, 0};
      for (const int node : fem_support::outline(mesh))
        for (const int axis : {0, 1})
          constrain(load.prescribed, {node}, axis, ((turned - before) * mesh.coordinates.col(node))[axis]);
      ASSERT_EQ(solver.solve_increment(state, load, increment).status, NewtonStatus::converged);
      solver.commit(state, increment);
    }
    const Eigen::Matrix2d quarter = Eigen::Rotation2Dd(M_PI / 2).toRotationMatrix();
    const Eigen::Matrix2d expected = quarter * start * quarter.transpose();
    EXPECT_LT(largest_difference(increment.stress, Stress(expected(0, 0), expected(1, 1), expected(0, 1))),
              1e-9 * start.norm());
    for (const Gradient& f : state.deformation) EXPECT_LT((f + Eigen::Matrix2d::Identity() - quarter).norm(), 1e-12);
    if (kinematics == Kinematics::updated_lagrangian) {
      EXPECT_LT((state.coordinates - quarter * mesh.coordinates).norm(), 1e-12);
    }
  }
}

/// One finite shear and compression, a step at a time: both geometries give the material the same F.
TEST(Patch, BothGeometriesCarryTheSameDeformation) {
  const Mesh mesh = fem_support::distorted_rectangle(1, 1, 3, 3, 0.05);
  std::vector<Gradient> deformation[2];
  std::vector<Stress> stress[2];
  for (const Kinematics kinematics : {Kinematics::updated_lagrangian, Kinematics::fixed_mesh}) {
    const auto which = static_cast<std::size_t>(kinematics);
    LinearElastic material(static_cast<std::size_t>(mesh.n_points()), {.strain = ElasticStrain::logarithmic});
    NewtonSolver solver(mesh, material, kinematics, {.tolerance = 1e-11, .displacement_tolerance = 1e-9});
    MeshState state = begin_stage(mesh, mesh.coordinates, material);
    Increment increment;
    Gradient total;
    total << 0.02, 0.15, 0, -0.1;
    for (int k = 0; k < 5; ++k) {
      IncrementLoad load{Eigen::VectorXd::Zero(mesh.n_dofs()), {}, 0, 0};
      for (const int node : fem_support::outline(mesh))
        for (const int axis : {0, 1})
          constrain(load.prescribed, {node}, axis, (0.2 * total * mesh.coordinates.col(node))[axis]);
      ASSERT_EQ(solver.solve_increment(state, load, increment).status, NewtonStatus::converged);
      solver.commit(state, increment);
    }
    for (const Gradient& f : state.deformation) EXPECT_LT((f - total).norm(), 1e-13);
    deformation[which] = state.deformation;
    stress[which] = increment.stress;
  }
  for (std::size_t i = 0; i < stress[0].size(); ++i)
    EXPECT_LT((stress[0][i] - stress[1][i]).norm(), 1e-12 * stress[0][i].norm());
}

}  // namespace
}  // namespace voussoir::fem
