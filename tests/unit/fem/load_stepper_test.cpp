#include <gtest/gtest.h>

#include "fem/load_stepper.hpp"
#include "fem/mesh_rectangle.hpp"
#include "tests/constrain.hpp"
#include "tests/fem_support.hpp"
#include "tests/throws.hpp"

namespace voussoir::fem {
namespace {

using fem_support::SofteningMaterial;

/// A sheared block whose material refuses increments that strain it too far.
struct Sheared {
  Mesh mesh = make_rectangle(1, 1, 3, 3);
  SofteningMaterial material;
  NewtonSolver solver;
  MeshState state;
  LoadPath path;
  explicit Sheared(double usable_strain, Kinematics kinematics = Kinematics::updated_lagrangian,
                   const NewtonOptions& options = {})
      : material(static_cast<std::size_t>(mesh.n_points()), {.too_stiff = 1.5, .usable_strain = usable_strain}),
        solver(mesh, material, kinematics, options),
        state(begin_stage(mesh, mesh.coordinates, material)) {
    path.external_force = [this](double) { return Eigen::VectorXd::Zero(mesh.n_dofs()).eval(); };
    path.prescribed_increment = [this](double from, double to) {
      Constraints c;
      for (const int axis : {0, 1}) constrain(c, mesh.node_set("base"), axis, 0);
      constrain(c, mesh.node_set("top"), 0, 0.04 * (to - from));
      constrain(c, mesh.node_set("top"), 1, 0);
      return c;
    };
  }
};

void expect_same_bits(const MeshState& a, const MeshState& b) {
  EXPECT_EQ(a.displacement, b.displacement);
  EXPECT_EQ(a.coordinates, b.coordinates);
  EXPECT_EQ(a.last_increment, b.last_increment);
  EXPECT_EQ(a.deformation, b.deformation);
  EXPECT_EQ(a.parameter, b.parameter);
  EXPECT_EQ(a.last_step, b.last_step);
  EXPECT_EQ(a.step_limit, b.step_limit);
}

TEST(LoadStepper, CutStepsGiveTheBitsOfSmallStepsAskedFor) {
  Sheared cut(0.03);  // a whole step strains about 0.04
  std::vector<double> reached;
  bool flags_are_right = true;
  const StepReport report = advance_load(cut.solver, cut.state, cut.path, {1, 2, 3}, {},
                                         {.on_converged =
                                              [&](const ConvergedStep& step) {
                                                reached.push_back(step.to);
                                                flags_are_right &= step.target == (step.to == std::floor(step.to));
                                                return true;
                                              },
                                          .on_failed = nullptr});
  ASSERT_EQ(report.status, StepStatus::finished) << report.message;
  EXPECT_GT(report.cuts, 0);
  EXPECT_TRUE(flags_are_right);
  EXPECT_EQ(reached.back(), 3);

  Sheared asked(1e300);
  const StepReport plain = advance_load(asked.solver, asked.state, asked.path, reached, {});
  EXPECT_EQ(plain.cuts, 0);
  asked.state.step_limit = cut.state.step_limit;  // all else must be equal
  expect_same_bits(cut.state, asked.state);
  EXPECT_EQ(cut.material.state(), asked.material.state());
}

/// Equilibrium ends at a parameter: steps cut until they would not move it converge, and lead nowhere.
TEST(LoadStepper, AStepTooSmallToMoveTheParameterIsGivenUp) {
  Sheared block(1e300);
  block.path.external_force = [&](double parameter) {
    const double force = parameter <= 1.3 ? 0.0 : std::nan("");
    return Eigen::VectorXd::Constant(block.mesh.n_dofs(), force).eval();
  };
  const StepReport report = advance_load(block.solver, block.state, block.path, {1, 2}, {.smallest = 1e-300});
  EXPECT_EQ(report.status, StepStatus::gave_up);
  EXPECT_LE(block.state.parameter, 1.3);
  EXPECT_NEAR(block.state.parameter, 1.3, 1e-12);
}

TEST(LoadStepper, ResumesWithTheSameBitsAtAnyIncrement) {
  const std::vector<double> targets{1, 2, 3};
  for (const Kinematics kinematics : {Kinematics::updated_lagrangian, Kinematics::fixed_mesh}) {
    Sheared straight(0.03, kinematics);
    std::vector<MeshState> states;
    std::vector<std::vector<std::byte>> materials;
    ASSERT_EQ(advance_load(straight.solver, straight.state, straight.path, targets, {},
                           {.on_converged =
                                [&](const ConvergedStep& step) {
                                  states.push_back(step.state);
                                  materials.push_back(straight.material.state());
                                  return true;
                                },
                            .on_failed = nullptr})
                  .status,
              StepStatus::finished);
    for (std::size_t k = 0; k < states.size(); ++k) {
      Sheared resumed(0.03, kinematics);
      resumed.state = states[k];
      resumed.material.set_state(materials[k]);
      ASSERT_EQ(advance_load(resumed.solver, resumed.state, resumed.path, targets, {}).status, StepStatus::finished);
      expect_same_bits(straight.state, resumed.state);
    }
  }
}

TEST(LoadStepper, GivesUpWithReasonAndLastGoodState) {
  Sheared block(1e-4);
  const std::vector<std::byte> before = block.material.state();
  int failed = 0;
  const StepReport report = advance_load(block.solver, block.state, block.path, {1}, {.smallest = 0.1},
                                         {.on_converged = nullptr, .on_failed = [&](const FailedStep&) { ++failed; }});
  EXPECT_EQ(report.status, StepStatus::gave_up);
  EXPECT_EQ(failed, 4);  // 1, 1/2, 1/4, 1/8
  EXPECT_NE(report.message.find("material_failed"), std::string::npos) << report.message;
  EXPECT_NE(report.message.find("strained too far"), std::string::npos) << report.message;
  EXPECT_EQ(block.state.parameter, 0);
  EXPECT_EQ(block.state.displacement.norm(), 0);
  EXPECT_EQ(block.material.state(), before);
}

TEST(LoadStepper, WhatDidNotConvergeIsNeverCommitted) {
  Sheared block(1e300, Kinematics::updated_lagrangian, {.tolerance = 1e-9, .max_iterations = 2});
  const std::vector<std::byte> before = block.material.state();
  const StepReport report = advance_load(block.solver, block.state, block.path, {1}, {});
  EXPECT_EQ(report.status, StepStatus::gave_up);
  EXPECT_EQ(report.increments, 0);
  EXPECT_EQ(report.last.status, NewtonStatus::max_iterations);
  EXPECT_NE(report.message.find("max_iterations"), std::string::npos) << report.message;
  EXPECT_EQ(block.state.parameter, 0);
  EXPECT_EQ(block.state.displacement.norm(), 0);
  EXPECT_EQ(block.material.state(), before);
}

TEST(LoadStepper, StopsWhenAsked) {
  Sheared block(1e300);
  const StepReport report = advance_load(
      block.solver, block.state, block.path, {1, 2, 3}, {},
      {.on_converged = [](const ConvergedStep& step) { return step.to < 2; }, .on_failed = nullptr});
  EXPECT_EQ(report.status, StepStatus::stopped);
  EXPECT_EQ(report.increments, 2);
  EXPECT_EQ(block.state.parameter, 2);
}

TEST(LoadStepper, GrowsAgainAfterACut) {
  Sheared block(1e300);
  NewtonSolver& solver = block.solver;
  block.state.step_limit = 0.25;
  std::vector<double> steps;
  static_cast<void>(advance_load(solver, block.state, block.path, {1, 2, 3}, {},
                                 {.on_converged =
                                      [&](const ConvergedStep& step) {
                                        steps.push_back(step.to - step.from);
                                        return true;
                                      },
                                  .on_failed = nullptr}));
  // Grown by 1.5 each; up to the target; a rest that would leave a sliver shared over two; whole steps again.
  EXPECT_EQ(steps, std::vector<double>({0.25, 0.375, 0.375, 0.5, 0.5, 1}));
  EXPECT_EQ(block.state.step_limit, 0);
}

TEST(LoadStepper, SteadyLoadOnALinearLawNeedsOneIterateAnIncrement) {
  const Mesh mesh = make_rectangle(1, 2, 2, 3);
  LinearElastic material(static_cast<std::size_t>(mesh.n_points()), {});
  NewtonSolver solver(mesh, material, Kinematics::fixed_mesh, {.tolerance = 1e-6, .initial_tangent_share = 0});
  MeshState state = begin_stage(mesh, mesh.coordinates, material);
  const LoadPath path{[&](double p) { return pressure_force(mesh.coordinates, mesh.edge_set("top"), p); },  // [Pa], so
                                                                                                            // small
                                                                                                            // that H
                      [&](double, double) {  // F_n^-1 is H
                        Constraints c;
                        for (const int axis : {0, 1}) constrain(c, mesh.node_set("base"), axis, 0);
                        return c;
                      },
                      0};
  int iterates = 0;
  static_cast<void>(advance_load(solver, state, path, {1, 2.5, 3.5}, {},
                                 {.on_converged =
                                      [&](const ConvergedStep& step) {
                                        iterates += step.report.iterations;
                                        return true;
                                      },
                                  .on_failed = nullptr}));
  EXPECT_EQ(state.parameter, 3.5);
  EXPECT_EQ(iterates, 3);
}

TEST(LoadStepper, ImpossibleInputIsRefused) {
  Sheared block(1e300);
  const auto advance = [&](const std::vector<double>& targets, const StepOptions& options) {
    static_cast<void>(advance_load(block.solver, block.state, block.path, targets, options));
  };
  expect_throws<std::invalid_argument>([&] { advance({1, 1}, {}); }, "targets must be finite and increase");
  expect_throws<std::invalid_argument>([&] { advance({-1}, {}); }, "targets must be finite and increase");
  expect_throws<std::invalid_argument>([&] { advance({std::nan("")}, {}); }, "targets must be finite and increase");
  expect_throws<std::invalid_argument>([&] { advance({1}, {.cut = 1}); }, "cut must be between");
  expect_throws<std::invalid_argument>([&] { advance({1}, {.smallest = 0}); }, "smallest must be in");
}

TEST(GeometricTargets, GrowThenWalkEvenly) {
  const double start = 1.0 / 700;  // 1 kPa on 700 kPa
  const std::vector<double> targets = geometric_targets(start, 1.5, 0.05);
  EXPECT_NEAR((targets[0] + start) / start, 1.5, 1e-12);
  EXPECT_NEAR((targets[4] + start) / (targets[3] + start), 1.5, 1e-12);
  double previous = 0;
  for (const double t : targets) {
    EXPECT_LE(t - previous, 0.05 + 1e-12);
    EXPECT_GT(t, previous);
    previous = t;
  }
  EXPECT_EQ(targets.back(), 1.0);
  EXPECT_NEAR(static_cast<double>(targets.size()), 30, 3);
  EXPECT_EQ(geometric_targets(0.5, 2, 1), std::vector<double>({0.5, 1.0}));
  expect_throws<std::invalid_argument>([&] { static_cast<void>(geometric_targets(0, 1.5, 0.05)); },
                                       "start must be positive");
}

}  // namespace
}  // namespace voussoir::fem
