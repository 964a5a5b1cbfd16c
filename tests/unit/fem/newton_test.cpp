#include <gtest/gtest.h>

#include <bit>
#include <random>

#include "fem/newton.hpp"
#include "tests/constrain.hpp"
#include "tests/fem_support.hpp"
#include "tests/throws.hpp"

namespace voussoir::fem {
namespace {

using fem_support::SofteningMaterial;
using fem_support::SofteningOptions;

/// A block on a rough base, compressed and sheared through its top.
struct Block {
  Mesh mesh = fem_support::distorted_rectangle(1, 2, 4, 8, 0.03);
  SofteningMaterial material;
  MeshState state;
  explicit Block(const SofteningOptions& options = {})
      : material(static_cast<std::size_t>(mesh.n_points()), options),
        state(begin_stage(mesh, mesh.coordinates, material)) {}

  [[nodiscard]] IncrementLoad load(double compression, double shear) const {
    IncrementLoad result{Eigen::VectorXd::Zero(mesh.n_dofs()), {}, 0, 0};
    constrain(result.prescribed, mesh.node_set("base"), 0, 0);
    constrain(result.prescribed, mesh.node_set("base"), 1, 0);
    constrain(result.prescribed, mesh.node_set("top"), 0, shear);
    constrain(result.prescribed, mesh.node_set("top"), 1, -compression);
    return result;
  }
};

/// The residual of an increment, formed apart from the solver.
double independent_residual(const Mesh& mesh, const IncrementLoad& load, const Increment& increment) {
  Eigen::VectorXd r = load.external_force - internal_force(mesh, increment.points, increment.stress).force;
  for (const auto& [dof, value] : load.prescribed) r[dof] = 0;
  return r.norm();
}

TEST(Newton, AndersonConvergesOnATangentThatIsTooStiff) {
  NewtonReport reports[2];
  for (const int depth : {0, 5}) {
    Block block({.strain_scale = 0.1, .too_stiff = 2.5});
    NewtonSolver solver(
        block.mesh, block.material, Kinematics::fixed_mesh,
        {.tolerance = 1e-6, .displacement_tolerance = 1e-5, .max_iterations = 200, .anderson_depth = depth});
    Increment increment;
    const IncrementLoad load = block.load(0.02, 0.03);
    NewtonReport& report = reports[depth > 0];
    report = solver.solve_increment(block.state, load, increment);
    ASSERT_EQ(report.status, NewtonStatus::converged) << "depth " << depth;
    EXPECT_NEAR(independent_residual(block.mesh, load, increment), report.residual, 1e-9 * report.reaction_norm);
    EXPECT_LE(report.residual, 1e-6 * report.reaction_norm);
    EXPECT_EQ(report.evaluations, block.material.evaluations);
    EXPECT_EQ(report.work, block.material.size() * static_cast<std::size_t>(report.evaluations));
    EXPECT_EQ(report.lane_steps, 3 * report.work);
    EXPECT_EQ(report.times.tangents, 2 * report.evaluations);
    EXPECT_LT(std::abs(report.times.material + report.times.tangents), 1) << "the material's time holds its tangents";
    EXPECT_EQ(block.material.increments_begun, 1);
    for (const auto& [dof, value] : load.prescribed) EXPECT_EQ(increment.displacement[dof], value);
  }
  EXPECT_LE(reports[1].iterations, 15);
  EXPECT_GT(reports[0].iterations, 2 * reports[1].iterations);
  RecordProperty("plain", reports[0].iterations);
  RecordProperty("anderson", reports[1].iterations);
}

/// The ratio of a node counts the load at this node and no other one: one node of an element is free and loaded.
TEST(Newton, TheNodalRatioCountsTheNodesOwnLoad) {
  const Mesh mesh = make_rectangle(1, 1, 1, 1);
  SofteningMaterial material(static_cast<std::size_t>(mesh.n_points()), {.strain_scale = 1e-3});
  const MeshState state = begin_stage(mesh, mesh.coordinates, material);
  NewtonSolver solver(mesh, material, Kinematics::fixed_mesh, {.max_iterations = 1});
  constexpr int loaded = 2;
  IncrementLoad load{Eigen::VectorXd::Zero(mesh.n_dofs()), {}, 0, 0};
  for (int node = 0; node < mesh.n_nodes(); ++node) {
    for (int axis = 0; axis < 2; ++axis) {
      if (node != loaded) constrain(load.prescribed, {node}, axis, 0);
    }
  }
  load.external_force.segment<2>(2 * loaded) = Eigen::Vector2d(1e4, 2e4);
  Increment increment;
  const NewtonReport report = solver.solve_increment(state, load, increment);
  ASSERT_EQ(report.status, NewtonStatus::max_iterations) << "a residual is left";
  const double scale = internal_force(mesh, increment.points, increment.stress).magnitude[loaded] +
                       std::hypot(1e4, 2e4);
  EXPECT_NEAR(report.largest_nodal_ratio, independent_residual(mesh, load, increment) / scale, 1e-12);
  EXPECT_GT(report.largest_nodal_ratio, 0.01) << "the test shows nothing";
}

TEST(Newton, SofteningConvergesWithAnderson) {
  // Past the peak (strain_scale) the true tangent is negative in shear while the one given stays elastic.
  Block block({.strain_scale = 0.012, .power = 1.5, .too_stiff = 2.0});
  NewtonSolver solver(block.mesh, block.material, Kinematics::fixed_mesh, {.max_iterations = 60});
  for (int k = 0; k < 10; ++k) {
    Increment increment;
    const NewtonReport report = solver.solve_increment(block.state, block.load(0, 0.006), increment);
    ASSERT_EQ(report.status, NewtonStatus::converged) << "increment " << k;
    solver.commit(block.state, increment);
  }
  EXPECT_NEAR(block.state.displacement[2 * block.mesh.node_set("top")[0]], 0.06, 1e-14);
}

TEST(Newton, NeverSaysConvergedWhereItIsNot) {
  int converged = 0;
  for (int limit = 1; limit <= 30; ++limit) {
    Block block({.too_stiff = 2.5});
    NewtonSolver solver(block.mesh, block.material, Kinematics::fixed_mesh, {.max_iterations = limit});
    Increment increment;
    const IncrementLoad load = block.load(0.02, 0.03);
    const NewtonReport report = solver.solve_increment(block.state, load, increment);
    const double residual = independent_residual(block.mesh, load, increment);
    const bool small = residual <= 1e-3 * increment.reactions.norm();
    const bool still = report.correction_history.back() <= 1e-2 * increment.displacement.norm();
    EXPECT_EQ(report.status, small && still ? NewtonStatus::converged : NewtonStatus::max_iterations);
    EXPECT_LE(report.iterations, limit);
    converged += report.status == NewtonStatus::converged ? 1 : 0;
  }
  EXPECT_GT(converged, 0) << "none converges: the test shows nothing";
  EXPECT_LT(converged, 30) << "all converge: the test shows nothing";
}

TEST(Newton, RefactoringSeldomGivesTheSameAnswer) {
  Eigen::VectorXd answers[2];
  for (const int every : {1, 1000}) {
    Block block;
    NewtonSolver solver(block.mesh, block.material, Kinematics::fixed_mesh,
                        {.tolerance = 1e-9, .displacement_tolerance = 1e-8, .refactor_every = every});
    Increment increment;
    const NewtonReport report = solver.solve_increment(block.state, block.load(0.01, 0.01), increment);
    ASSERT_EQ(report.status, NewtonStatus::converged);
    EXPECT_EQ(report.factorisations, every > 1 ? 2 : report.iterations + 1);  // one for the first step
    answers[every > 1] = increment.displacement;
  }
  EXPECT_LT((answers[0] - answers[1]).norm(), 1e-7 * answers[0].norm());
}

TEST(Newton, PredictorOfASteadyPathStartsCloser) {
  double start[2] = {};  // residual of the first iterate of a third increment
  for (const double ratio : {0.0, 0.5}) {
    Block block({.strain_scale = 0.02, .too_stiff = 1.5});
    NewtonSolver solver(block.mesh, block.material, Kinematics::fixed_mesh, {.tolerance = 1e-6});
    Increment increment;
    for (int k = 0; k < 2; ++k) {
      ASSERT_EQ(solver.solve_increment(block.state, block.load(0.004, 0.004), increment).status,
                NewtonStatus::converged);
      solver.commit(block.state, increment);
    }
    IncrementLoad load = block.load(0.002, 0.002);
    load.predictor_ratio = ratio;
    const NewtonReport report = solver.solve_increment(block.state, load, increment);
    ASSERT_EQ(report.status, NewtonStatus::converged);
    for (const auto& [dof, value] : load.prescribed) EXPECT_EQ(increment.displacement[dof], value);
    start[ratio > 0] = report.residual_history.front();
  }
  EXPECT_LT(start[1], 0.5 * start[0]);
}

TEST(Newton, FailuresHaveNames) {
  Increment increment;
  {
    Block block({.usable_strain = 1e-3});
    NewtonSolver solver(block.mesh, block.material, Kinematics::fixed_mesh, {});
    const NewtonReport report = solver.solve_increment(block.state, block.load(0.1, 0), increment);
    EXPECT_EQ(report.status, NewtonStatus::material_failed);
    EXPECT_NE(report.material.message.find("strained too far"), std::string::npos);
  }
  {
    Block block;
    NewtonSolver solver(block.mesh, block.material, Kinematics::updated_lagrangian, {});
    EXPECT_EQ(solver.solve_increment(block.state, block.load(3, 0), increment).status, NewtonStatus::inverted_element);
    EXPECT_EQ(solver.solve_increment(block.state, block.load(std::nan(""), 0), increment).status,
              NewtonStatus::not_finite);
    IncrementLoad load = block.load(0.01, 0);
    load.external_force[30] = std::numeric_limits<double>::infinity();
    EXPECT_EQ(solver.solve_increment(block.state, load, increment).status, NewtonStatus::not_finite);
    block.state.coordinates.col(block.mesh.elements[5][0]) += Point(1, 1);
    EXPECT_EQ(solver.solve_increment(block.state, block.load(0.01, 0), increment).status,
              NewtonStatus::inverted_element);
  }
  {
    Block block({.too_stiff = -1});  // neither the tangent nor the initial one is positive
    NewtonSolver solver(block.mesh, block.material, Kinematics::fixed_mesh, {});
    EXPECT_EQ(solver.solve_increment(block.state, block.load(0.01, 0), increment).status,
              NewtonStatus::not_positive_definite);
  }
}

TEST(Newton, VanishedTangentIsCarriedByTheInitialOne) {
  Block block;
  const MeshState with_stiff_start = block.state;
  SofteningMaterial open(static_cast<std::size_t>(block.mesh.n_points()), {.too_stiff = 0});  // tangent zero everywhere
  NewtonSolver solver(block.mesh, open, Kinematics::fixed_mesh, {.max_iterations = 200, .initial_tangent_share = 1.0});
  Increment increment;
  EXPECT_EQ(solver.solve_increment(with_stiff_start, block.load(0.01, 0), increment).status, NewtonStatus::converged);
}

TEST(Newton, NoiseFloorsWidenTheBoundsAndCanBeSwitchedOff) {
  NewtonReport quiet, noisy;
  for (const double factor : {0.0, 1.5}) {
    Block block({.noise = 1e3});
    NewtonSolver solver(block.mesh, block.material, Kinematics::fixed_mesh, {.noise_factor = factor});
    Increment increment;
    NewtonReport& report = factor > 0 ? noisy : quiet;
    report = solver.solve_increment(block.state, block.load(0.01, 0), increment);
    ASSERT_EQ(report.status, NewtonStatus::converged);
    EXPECT_NEAR(report.residual_bound - report.noise_floor, 1e-3 * report.reaction_norm, 1e-13 * report.reaction_norm);
  }
  EXPECT_EQ(quiet.noise_floor, 0);
  EXPECT_GT(noisy.noise_floor, 0);
  EXPECT_DOUBLE_EQ(quiet.correction_bound, 1e-2 * quiet.increment_norm);
  EXPECT_GT(noisy.correction_bound, 1.001e-2 * noisy.increment_norm);
}

/// Points at their step limit keep an increment from converging only where it shall settle, and only where a stress
/// error as large as theirs would show beside the tolerance.
TEST(Newton, UnsettledPointsCountWhereTheLoadAsksForIt) {
  const auto solve = [](double unsettled, bool settle) {
    Block block({.unsettled = unsettled});
    NewtonSolver solver(block.mesh, block.material, Kinematics::fixed_mesh, {});
    IncrementLoad load = block.load(0.01, 0);
    load.settle = settle;
    Increment increment;
    return solver.solve_increment(block.state, load, increment);
  };
  const NewtonReport one = solve(1.0, false);                         // 1 Pa: the force is a multiple of the stress
  const double limit = 1e-3 * one.reference() / one.unsettled_force;  // [Pa]
  EXPECT_EQ(solve(1.01 * limit, false).status, NewtonStatus::converged);
  EXPECT_EQ(solve(0.99 * limit, true).status, NewtonStatus::converged);
  EXPECT_EQ(solve(1.01 * limit, true).status, NewtonStatus::max_iterations);
}

/// A law that is a fixed but rough function of the gradient, as an RVE's is: independent errors at every new gradient.
class RoughMaterial final : public SofteningMaterial {
 public:
  RoughMaterial(std::size_t n, double noise)
      : SofteningMaterial(n, {.strain_scale = 0.02, .too_stiff = 1.5}), noise_(noise) {}
  BatchReport evaluate(std::span<const Gradient> gradients, std::span<Stress> stress,
                       std::span<Tangent> tangent) override {
    BatchReport report = SofteningMaterial::evaluate(gradients, stress, tangent);
    report.stress_noise = noise_;
    for (std::size_t i = 0; i < size(); ++i) {
      std::seed_seq seed{i,
                         static_cast<std::size_t>(std::bit_cast<std::uint64_t>(gradients[i](1, 1)) >> 8 & 0xffffffff),
                         static_cast<std::size_t>(std::bit_cast<std::uint64_t>(gradients[i](0, 1)) >> 8 & 0xffffffff)};
      std::mt19937 random(seed);
      std::normal_distribution<double> error(0, noise_);
      for (double& component : stress[i]) component += error(random);
    }
    return report;
  }

 private:
  double noise_;
};

/// Stresses times the next factor of a list at each evaluation, the last one from then on.
class ScriptedMaterial final : public SofteningMaterial {
 public:
  ScriptedMaterial(std::size_t n, std::vector<double> factors)
      : SofteningMaterial(n, {}), factors_(std::move(factors)) {}
  BatchReport evaluate(std::span<const Gradient> gradients, std::span<Stress> stress,
                       std::span<Tangent> tangent) override {
    const BatchReport report = SofteningMaterial::evaluate(gradients, stress, tangent);
    const double factor = factors_[std::min(next_++, factors_.size() - 1)];
    for (Stress& s : stress) s *= factor;
    return report;
  }

 private:
  std::vector<double> factors_;
  std::size_t next_ = 0;
};

TEST(Newton, OfHalvedStepsThatAllGrowTheBestIsKept) {
  const auto second_iterate = [](int halvings, std::vector<double> factors) {
    Block block;
    ScriptedMaterial material(static_cast<std::size_t>(block.mesh.n_points()), std::move(factors));
    NewtonSolver solver(block.mesh, material, Kinematics::fixed_mesh, {.max_iterations = 2, .max_halvings = halvings});
    Increment increment;
    const NewtonReport report = solver.solve_increment(block.state, block.load(0.003, 0.004), increment);
    EXPECT_EQ(report.evaluations, halvings + 2);
    EXPECT_EQ(report.work, material.size() * static_cast<std::size_t>(halvings + 2));
    EXPECT_EQ(report.lane_steps, 3 * report.work);
    EXPECT_EQ(report.residual, report.residual_history.back());
    return std::pair(increment.displacement, report.residual);
  };
  const auto half = second_iterate(1, {1, 1e5, 1e3});  // what was tried last is the best
  const auto kept = second_iterate(2, {1, 1e5, 1e3, 1e4});
  EXPECT_EQ(kept.first, half.first);
  EXPECT_EQ(kept.second, half.second);
}

TEST(Newton, NoiseIsNotChased) {
  for (const double noise : {1e2, 1e3, 5e3}) {  // against about 5e4 Pa of stress
    Block block;
    RoughMaterial rough(static_cast<std::size_t>(block.mesh.n_points()), noise);
    NewtonSolver solver(block.mesh, rough, Kinematics::fixed_mesh, {.noise_limit = 1e9});
    for (int k = 0; k < 4; ++k) {
      Increment increment;
      const NewtonReport report = solver.solve_increment(block.state, block.load(0.003, 0.004), increment);
      ASSERT_EQ(report.status, NewtonStatus::converged) << "noise " << noise << " Pa, increment " << k;
      EXPECT_LE(report.iterations, 8) << "noise " << noise << " Pa, increment " << k;
      solver.commit(block.state, increment);
    }
  }
}

TEST(Newton, NoiseBeyondItsLimitIsNoConvergence) {
  Block block;
  RoughMaterial rough(static_cast<std::size_t>(block.mesh.n_points()), 2e4);  // 40 % of the stress
  NewtonSolver solver(block.mesh, rough, Kinematics::fixed_mesh, {.max_iterations = 10});
  Increment increment;
  const NewtonReport report = solver.solve_increment(block.state, block.load(0.003, 0.004), increment);
  EXPECT_EQ(report.status, NewtonStatus::max_iterations);
  EXPECT_NEAR(report.residual_bound, 1.5 * report.noise_floor, 1e-9 * report.residual_bound);  // floor = 2 x tolerance
  EXPECT_GT(report.residual, report.residual_bound);
}

TEST(Newton, ImpossibleOptionsAreRefused) {
  Block block;
  const auto make = [&](const NewtonOptions& options) {
    NewtonSolver solver(block.mesh, block.material, Kinematics::fixed_mesh, options);
  };
  expect_throws<std::invalid_argument>([&] { make({.tolerance = 0}); }, "tolerances must be positive");
  expect_throws<std::invalid_argument>([&] { make({.max_iterations = 0}); }, "max_iterations and refactor_every");
  expect_throws<std::invalid_argument>([&] { make({.anderson_depth = -1}); }, "Anderson's depth");
  expect_throws<std::invalid_argument>([&] { make({.length_tolerance = -1e-12}); }, "length tolerance must not");
  EXPECT_NO_THROW(make({.length_tolerance = 0})) << "0 leaves the displacement tolerance alone in force";
  SofteningMaterial other(7, {});
  expect_throws<std::invalid_argument>([&] { NewtonSolver(block.mesh, other, Kinematics::fixed_mesh, {}); },
                                       "the material has 7 points");
}

}  // namespace
}  // namespace voussoir::fem
