// Where no iterate meets its stress again: the increment is relaxed, or it fails and nothing of it stays.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "fem/mesh_rectangle.hpp"
#include "tests/constrain.hpp"
#include "tests/fem_support.hpp"

namespace voussoir::fem {
namespace {

/// Elastic (nu = 0, E) until its vertical strain exceeds a limit; beyond, the points of element 0 lose a share of their
/// stress for good, in every other evaluation: grains that collapse in one iterate and not in the next. The tangent of
/// these points is three times too stiff.
class CollapsingMaterial final : public MaterialBatch {
 public:
  static constexpr double young = 1e7, limit = 1e-3, loss = 0.5, too_stiff = 3;

  int tangents_asked = 0;
  int settled_from = 0;  ///< before this evaluation a point is not at rest, and may be off by 1 MPa
  int fails_from = std::numeric_limits<int>::max();  ///< the first evaluation that is not usable

  double committed_error = 0;  ///< largest that a committed evaluation has told; they fall

  explicit CollapsingMaterial(std::size_t n) : committed_(n), trial_(n) {}
  [[nodiscard]] std::size_t size() const override { return committed_.size(); }
  void begin_increment() override {}
  BatchReport evaluate(std::span<const Gradient> gradients, std::span<Stress> stress,
                       std::span<Tangent> tangent) override {
    const bool collapses = ++evaluations_ % 2 == 1;
    if (!tangent.empty()) ++tangents_asked;
    for (std::size_t i = 0; i < size(); ++i) {
      const Gradient& h = gradients[i];
      trial_[i].strain = committed_[i].strain + Eigen::Vector3d(h(0, 0), h(1, 1), h(0, 1) + h(1, 0));
      const bool beyond = i < 4 && -trial_[i].strain[1] > limit;
      trial_[i].collapsed = committed_[i].collapsed || (beyond && collapses);
    }
    answer(trial_, stress, tangent);
    BatchReport report;
    report.work = size();
    report.lane_steps = 3 * size();
    report.deferral_error = 1.0 / evaluations_;
    report.usable = evaluations_ < fails_from;
    if (evaluations_ < settled_from) report.unsettled_stress = 1e6;
    if (!report.usable) report.message = "point 3: overlap";
    return report;
  }
  void commit() override {
    committed_ = trial_;
    committed_error = std::max(committed_error, 1.0 / evaluations_);
  }
  void committed(std::span<Stress> stress, std::span<Tangent> tangent) const override {
    answer(committed_, stress, tangent);
  }
  [[nodiscard]] std::vector<PointField> fields() const override { return {}; }
  [[nodiscard]] std::vector<std::byte> state() const override {
    std::vector<std::byte> bytes;
    for (const Point& p : committed_) {
      for (const double e : p.strain) {
        const auto part = std::bit_cast<std::array<std::byte, 8>>(e);
        bytes.insert(bytes.end(), part.begin(), part.end());
      }
      bytes.push_back(std::byte{p.collapsed});
    }
    return bytes;
  }
  void set_state(std::span<const std::byte> bytes) override {
    for (Point& p : committed_) {
      for (double& e : p.strain) {
        std::array<std::byte, 8> part;
        std::copy_n(bytes.begin(), 8, part.begin());
        e = std::bit_cast<double>(part);
        bytes = bytes.subspan(8);
      }
      p.collapsed = bytes[0] != std::byte{0};
      bytes = bytes.subspan(1);
    }
  }

 private:
  struct Point {
    Eigen::Vector3d strain = Eigen::Vector3d::Zero();
    bool collapsed = false;
  };
  static void answer(const std::vector<Point>& points, std::span<Stress> stress, std::span<Tangent> tangent) {
    const Tangent d = plane_strain_stiffness(young, 0);
    for (std::size_t i = 0; i < points.size(); ++i) {
      stress[i] = (points[i].collapsed ? 1 - loss : 1.0) * (d * points[i].strain);
      if (!tangent.empty()) tangent[i] = (i < 4 ? too_stiff : 1.0) * d;
    }
  }
  std::vector<Point> committed_;
  std::vector<Point> trial_;
  int evaluations_ = 0;
};

/// Two elements, one above the other, compressed to 1.5 times the limit in one step.
struct Pillar {
  Mesh mesh = make_rectangle(1, 2, 1, 2);
  CollapsingMaterial material{static_cast<std::size_t>(mesh.n_points())};
  NewtonSolver solver{
      mesh,
      material,
      Kinematics::fixed_mesh,
      {.tolerance = 1e-6, .displacement_tolerance = 1e-5, .initial_tangent_share = 0, .anderson_depth = 0}};
  MeshState state = begin_stage(mesh, mesh.coordinates, material);
  LoadPath path;
  double reaction = 0;
  NewtonReport last;

  Pillar() {
    path.external_force = [this](double) { return Eigen::VectorXd::Zero(mesh.n_dofs()).eval(); };
    path.prescribed_increment = [this](double from, double to) {
      Constraints c;
      constrain(c, mesh.node_set("base"), 1, 0);
      constrain(c, {mesh.node_set("base").front()}, 0, 0);
      constrain(c, mesh.node_set("top"), 1, -2 * 1.5 * CollapsingMaterial::limit * (to - from));
      return c;
    };
  }
  StepReport advance(const StepOptions& options) {
    return advance_load(solver, state, path, {1}, options,
                        {.on_converged =
                             [this](const ConvergedStep& step) {
                               reaction = 0;
                               for (const int node : mesh.node_set("top"))
                                 reaction -= step.increment.reactions[2 * node + 1];
                               last = step.report;
                               return true;
                             },
                         .on_failed = nullptr});
  }
};

TEST(Relaxation, CollapseEndsInTheEquilibriumBehindIt) {
  Pillar pillar;
  const StepReport report = pillar.advance({.relax_below = 1, .use_predictor = false});
  ASSERT_EQ(report.status, StepStatus::finished) << report.message;
  EXPECT_EQ(report.cuts, 0);
  EXPECT_EQ(report.relaxed, 1);
  EXPECT_GT(pillar.last.relaxations, 0);
  EXPECT_GT(pillar.last.viscous_work, 0);
  EXPECT_LE(pillar.last.residual, 1e-6 * pillar.reaction);
  EXPECT_EQ(pillar.last.work, pillar.material.size() * static_cast<std::size_t>(pillar.last.evaluations));
  EXPECT_EQ(pillar.last.lane_steps, 3 * pillar.last.work);
  EXPECT_EQ(pillar.material.tangents_asked, pillar.last.evaluations - pillar.last.relaxations);  // substeps keep the
                                                                                                 // matrix
  // Springs in series: the element that has lost half its stiffness strains twice as much as the other
  // (strains are sums over substeps, so to the order of the strains themselves).
  const double expected = CollapsingMaterial::young * 3 * CollapsingMaterial::limit /
                          (1 + 1 / (1 - CollapsingMaterial::loss));
  EXPECT_NEAR(pillar.reaction, expected, 5e-4 * expected);
  const int middle = pillar.mesh.elements[0][3];
  EXPECT_NEAR(pillar.state.displacement[2 * middle + 1], -2 * CollapsingMaterial::limit,
              2e-3 * CollapsingMaterial::limit);
  EXPECT_NEAR(pillar.state.deformation[0](1, 1), -2 * CollapsingMaterial::limit, 2e-3 * CollapsingMaterial::limit);
  EXPECT_EQ(pillar.state.last_increment, pillar.state.displacement);  // the whole way
  EXPECT_EQ(pillar.last.material.deferral_error, pillar.material.committed_error);
}

TEST(SubstepFactor, FollowsTheWorkWithinItsBounds) {
  SubstepFactor factor(1, {.least_factor = 0.25, .largest_factor = 3, .factor_growth = 1.5});
  factor.learn(2, 1, 1);  // half of the work was done: twice the factor would have done it all
  EXPECT_EQ(factor.value(), 1.5);
  factor.learn(2, -1, 1);  // half as much again
  EXPECT_EQ(factor.value(), 1);
  factor.learn(2, -18, 1);
  EXPECT_EQ(factor.value(), 0.25);
  for (int k = 0; k < 9; ++k) factor.learn(-1, 1, 1);
  EXPECT_EQ(factor.value(), 3);
}

TEST(SubstepFactor, AsksForANewMatrixWhereTheLeastFactorOvershoots) {
  SubstepFactor factor(1, {.most_overshoots = 3});
  for (int k = 0; k < 2; ++k) factor.learn(1, -9, 1);
  EXPECT_FALSE(factor.needs_new_matrix());
  factor.learn(1, 0.5, 1);  // a substep that falls short: the count begins anew
  for (int k = 0; k < 3; ++k) factor.learn(1, -9, 1);
  EXPECT_TRUE(factor.needs_new_matrix());
  factor.learn(1, 0.9, 1);  // of the substep that has made it
  EXPECT_FALSE(factor.needs_new_matrix());
  EXPECT_EQ(factor.value(), 1);
}

TEST(SubstepFactor, HalvesItsLargestValueWhereTheResidualStays) {
  SubstepFactor factor(1, {.largest_factor = 3, .most_in_vain = 5, .least_cap = 0.5});
  for (const double largest : {1.5, 0.75, 0.5, 0.5}) {
    while (!factor.needs_new_matrix()) factor.learn(1, 0.9, 1);
    factor.learn(1, 0.9, 1);
    EXPECT_EQ(factor.value(), std::min(1.0, largest));
    for (int k = 0; k < 4; ++k) factor.learn(1, 0.9, 1);
    EXPECT_EQ(factor.value(), largest);
  }
  for (int k = 0; k < 50; ++k) factor.learn(1, 0.9, std::pow(0.8, k));  // as long as it falls, the matrix serves
  EXPECT_FALSE(factor.needs_new_matrix());
}

TEST(Relaxation, WithoutItNoCutFindsTheEquilibrium) {
  Pillar pillar;
  const StepReport report = pillar.advance({.relax_below = 0, .use_predictor = false});
  EXPECT_EQ(report.status, StepStatus::gave_up);
  EXPECT_EQ(report.relaxed, 0);
}

TEST(Relaxation, OnlyStepsOfTheSizeAllowedAreRelaxed) {
  Pillar pillar;
  const StepReport report = pillar.advance({.relax_below = 0.25, .use_predictor = false});
  ASSERT_EQ(report.status, StepStatus::finished) << report.message;
  EXPECT_GE(report.cuts, 2);
  EXPECT_GE(report.relaxed, 1);
}

TEST(Relaxation, WhatNeverCalmsFailsAndLeavesNothing) {
  Pillar pillar;
  const std::vector<std::byte> before = pillar.material.state();
  const StepReport report = pillar.advance({.smallest = 1, .relax_below = 1, .relaxation = {.max_substeps = 1}});
  EXPECT_EQ(report.status, StepStatus::gave_up);
  EXPECT_NE(report.message.find("relaxation"), std::string::npos) << report.message;
  EXPECT_EQ(pillar.material.state(), before);
  EXPECT_EQ(pillar.state.displacement.norm(), 0);
  EXPECT_EQ(pillar.state.coordinates, pillar.mesh.coordinates);
  EXPECT_EQ(pillar.state.parameter, 0);
}

TEST(Relaxation, WhatFailsSaysWhy) {
  Pillar pillar;
  pillar.material.fails_from = 2;  // one good iterate, then none
  const StepReport report = pillar.advance({.smallest = 1, .relax_below = 1, .relaxation = {.near_residual = 0}});
  EXPECT_EQ(report.status, StepStatus::gave_up);
  EXPECT_EQ(report.last.status, NewtonStatus::material_failed);
  EXPECT_NE(report.message.find("point 3: overlap"), std::string::npos) << report.message;
}

/// The pillar far below its limit, where two evaluations find the equilibrium.
NewtonReport settle(int settled_from, const StepOptions& options) {
  Pillar pillar;
  pillar.material.settled_from = settled_from;
  const auto whole = pillar.path.prescribed_increment;
  pillar.path.prescribed_increment = [=](double from, double to) { return whole(from * 0.01, to * 0.01); };
  const StepReport report = pillar.advance(options);
  EXPECT_EQ(report.status, StepStatus::finished) << report.message;
  EXPECT_LE(pillar.last.residual, pillar.last.residual_bound);
  return pillar.last;
}

TEST(Relaxation, GrainsAtTheStepLimitGetFurtherEvaluationsToComeToRest) {
  const StepOptions options{.relax_below = 1, .use_predictor = false};
  const NewtonReport at_rest = settle(0, options);
  EXPECT_EQ(at_rest.unsettled_force, 0);
  const NewtonReport later = settle(at_rest.evaluations + 2, options);
  EXPECT_EQ(later.unsettled_force, 0);
  EXPECT_EQ(later.evaluations, at_rest.evaluations + 2);
}

TEST(Relaxation, GrainsThatNeverComeToRestAreReported) {
  const StepOptions options{.relax_below = 1, .use_predictor = false};
  const NewtonReport never = settle(std::numeric_limits<int>::max(), options);
  EXPECT_GT(never.unsettled_force, never.residual_bound);
  EXPECT_EQ(never.evaluations, settle(0, options).evaluations + options.relaxation.max_settling);
  const NewtonReport not_relaxed = settle(std::numeric_limits<int>::max(), {.relax_below = 0, .use_predictor = false});
  EXPECT_GT(not_relaxed.unsettled_force, not_relaxed.residual_bound);  // nothing is spent where nothing may be relaxed
  EXPECT_EQ(not_relaxed.relaxations, 0);
}

TEST(Relaxation, TooFarFromEquilibriumIsCutInstead) {
  Pillar pillar;
  const StepReport report = pillar.advance({.smallest = 1, .relax_below = 1, .relaxation = {.far_residual = 1e-9}});
  EXPECT_EQ(report.status, StepStatus::gave_up);
  EXPECT_EQ(report.last.relaxations, 0);
}

}  // namespace
}  // namespace voussoir::fem
