/// The stages of a tunnel on linear elasticity: ground at rest, the held opening, the volume loss.
#include <gtest/gtest.h>

#include "fem/load_stepper.hpp"
#include "fem/mesh_rectangle.hpp"
#include "fem/mesh_tunnel.hpp"
#include "tests/constrain.hpp"
#include "tests/fem_support.hpp"
#include "tests/shrinking_opening.hpp"

namespace voussoir::fem {
namespace {

constexpr double gamma = 2e4;      ///< unit weight [N/m3]
constexpr double surcharge = 1e3;  ///< [Pa]
constexpr double young = 3e7;      ///< [Pa]
constexpr double poisson = 0.3;
constexpr double k0 = poisson / (1 - poisson);

Constraints rollers(const Mesh& mesh) {
  Constraints c;
  constrain(c, mesh.node_set("base"), 0, 0);
  constrain(c, mesh.node_set("base"), 1, 0);
  constrain(c, mesh.node_set("axis"), 0, 0);
  constrain(c, mesh.node_set("side"), 0, 0);
  return c;
}

TEST(Geostatic, ColumnIsExact) {
  constexpr double height = 10;
  const Mesh mesh = make_rectangle(3, height, 2, 5);
  LinearElastic material(static_cast<std::size_t>(mesh.n_points()), {.young = young, .poisson = poisson});
  NewtonSolver solver(mesh, material, Kinematics::fixed_mesh, {.tolerance = 1e-10, .initial_tangent_share = 0});
  const MeshState state = begin_stage(mesh, mesh.coordinates, material);
  const IncrementLoad load{body_force(mesh, mesh.coordinates, {0, -gamma}) +
                               pressure_force(mesh.coordinates, mesh.edge_set("top"), surcharge),
                           rollers(mesh), 0, 0};
  Increment increment;
  ASSERT_EQ(solver.solve_increment(state, load, increment).status, NewtonStatus::converged);
  const GeostaticStress expected{{{0, gamma}}, height, surcharge, 1, [](std::size_t, double) { return k0; }};
  for (int i = 0; i < mesh.n_points(); ++i)
    EXPECT_LT((increment.stress[i] - expected(increment.points.positions.col(i))).norm(), 1e-12 * gamma * height);
  const double modulus = young * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson));
  for (int node = 0; node < mesh.n_nodes(); ++node) {
    const double y = mesh.coordinates(1, node);
    EXPECT_NEAR(increment.displacement[2 * node + 1], -(surcharge * y + gamma * (height * y - y * y / 2)) / modulus,
                1e-14);
  }
  double base = 0;
  for (const int node : mesh.node_set("base")) base += increment.reactions[2 * node + 1];
  EXPECT_NEAR(base, 3 * (gamma * height + surcharge), 1e-7);
}

/// The whole tunnel: gravity with the opening held by (15), (16) on the fixed mesh, then the opening fixed where it
/// stands, then the volume loss in the updated geometry.
class ElasticTunnel : public testing::Test {
 protected:
  static constexpr double height = 35;
  Mesh mesh_ = make_half_tunnel({.size_near = 0.8, .size_far = 3});
  LinearElastic material_{static_cast<std::size_t>(mesh_.n_points()),
                          {.young = young, .poisson = poisson, .initial_stress = Stress(-surcharge, -surcharge, 0)}};
  Eigen::VectorXd weight_ = body_force(mesh_, mesh_.coordinates, {0, -gamma});
  Eigen::VectorXd top_ = pressure_force(mesh_.coordinates, mesh_.edge_set("top"), surcharge);

  /// K0 = 1 at the initial 1 kPa; the elastic ground adds its own share of the rest.
  [[nodiscard]] static GeostaticStress at_rest(double lambda) {
    return {{{0, gamma}}, height, surcharge, lambda, [](std::size_t, double s) {
              return s == -surcharge ? 1.0 : (-surcharge + k0 * (s + surcharge)) / s;
            }};
  }
  [[nodiscard]] Eigen::VectorXd gravity_force(double lambda) const {
    return lambda * weight_ + top_ + traction_force(mesh_.coordinates, mesh_.edge_set("opening"), at_rest(lambda));
  }
  StepReport gravity(MeshState& state) {
    NewtonSolver solver(mesh_, material_, Kinematics::fixed_mesh, {.tolerance = 1e-6, .displacement_tolerance = 1e-5});
    const LoadPath path{[this](double lambda) { return gravity_force(lambda); },
                        [this](double, double) { return rollers(mesh_); }, gravity_force(1).norm()};
    return advance_load(solver, state, path, geometric_targets(surcharge / (gamma * height), 1.5, 0.1), {});
  }
};

TEST_F(ElasticTunnel, GravityGivesTheGroundAtRest) {
  MeshState state = begin_stage(mesh_, mesh_.coordinates, material_);
  ASSERT_EQ(gravity(state).status, StepStatus::finished);
  EXPECT_EQ(state.coordinates, mesh_.coordinates);
  std::vector<Stress> stress(material_.size());
  std::vector<Tangent> tangent(material_.size());
  material_.committed(stress, tangent);
  const GaussPoints points = gauss_points(mesh_, mesh_.coordinates);
  double worst = 0;
  for (int i = 0; i < mesh_.n_points(); ++i)
    worst = std::max(worst, (stress[i] - at_rest(1)(points.positions.col(i))).norm() / (gamma * height));
  // 0.10 % was measured: a linear stress is not integrated exactly in curved elements, and the fixed mesh's finite
  // strain makes the elastic law a little nonlinear.
  EXPECT_LT(worst, 2e-3);
}

TEST_F(ElasticTunnel, ReactionsTakeOverTheTractionsAndTheLossRemovesItsArea) {
  MeshState state = begin_stage(mesh_, mesh_.coordinates, material_);
  ASSERT_EQ(gravity(state).status, StepStatus::finished);
  const Eigen::VectorXd held = traction_force(mesh_.coordinates, mesh_.edge_set("opening"), at_rest(1));

  state = begin_stage(mesh_, mesh_.coordinates, material_);
  NewtonSolver solver(mesh_, material_, Kinematics::updated_lagrangian, {});
  IncrementLoad still{weight_ + top_, rollers(mesh_), 0, 0};
  shrink_opening(still.prescribed, mesh_, 0, 0);
  Increment increment;
  ASSERT_EQ(solver.solve_increment(state, still, increment).status, NewtonStatus::converged);
  double difference = 0;
  for (const int node : mesh_.node_set("opening"))
    if (mesh_.coordinates(0, node) > 0)  // on the axis the support's force comes on top
      difference += (increment.reactions.segment<2>(2 * node) - held.segment<2>(2 * node)).squaredNorm();
  EXPECT_LT(std::sqrt(difference), 1e-4 * (weight_ + top_).norm());

  const LoadPath path{[&](double) { return still.external_force; },
                      [&](double from, double to) {
                        Constraints c = rollers(mesh_);
                        shrink_opening(c, mesh_, from, to);
                        return c;
                      },
                      0};
  std::vector<double> targets;
  for (int k = 1; k <= 20; ++k) targets.push_back(0.01 * k);
  const double before = area_left_of(mesh_.coordinates, mesh_.edge_set("opening"));
  double worst = 0;
  const StepReport report = advance_load(solver, state, path, targets, {},
                                         {.on_converged =
                                              [&](const ConvergedStep& step) {
                                                const double area = area_left_of(step.state.coordinates,
                                                                                 mesh_.edge_set("opening"));
                                                worst = std::max(worst, std::abs(area / before - (1 - step.to)));
                                                return true;
                                              },
                                          .on_failed = nullptr});
  ASSERT_EQ(report.status, StepStatus::finished) << report.message;
  EXPECT_LT(worst, 1e-12);
  const int crown = mesh_.point("crown");
  EXPECT_NEAR(-state.displacement[2 * crown + 1], 5 * (1 - std::sqrt(0.8)), 1e-13);  // eq. (19): 0.528 m
  EXPECT_LT(state.displacement[2 * mesh_.node_set("top").back() + 1], -0.05);        // the surface settles above it
}

}  // namespace
}  // namespace voussoir::fem
