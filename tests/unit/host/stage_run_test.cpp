// An increment that took several steps: what its report sums over them, and what it takes from the last of them.
#include "host/stages/stage_run.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <vector>

#include "fem/mesh_rectangle.hpp"
#include "host/record/provenance.hpp"
#include "host/stages/ground_record.hpp"

namespace voussoir::host {
namespace {

/// One linear elastic element, and a stage of two targets whose steps the test makes up.
class Steps : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::remove_all(options_.folder);
    std::filesystem::create_directories(options_.folder);
    log_.emplace(options_.folder / "run.log", false);
    Case input;
    input.fingerprint = "host_stage_run_test";
    StageSettings settings;
    settings.defer = 0.01;
    run_.emplace(options_, provenance_of(options_, input, "test"), mesh_, mesh_data(mesh_), settings, *log_);
    MaterialCase material;
    material.kind = MaterialKind::linear_elastic;
    run_->open_ground(material, {});
    stage_.name = "test";
    stage_.targets = {1, 2};
    run_->recorder().begin_stage(stage_.name, 0, 2);
    stage_.on_record = [&](IncrementReport& report) { recorded_.push_back(report); };
    increment_.gradients.assign(static_cast<std::size_t>(mesh_.n_points()), fem::Gradient::Zero());
    increment_.reactions = Eigen::VectorXd::Zero(mesh_.n_dofs());
  }

  [[nodiscard]] fem::ConvergedStep step(double from, double to, bool target, const fem::NewtonReport& report) {
    return {from, to, target, report, increment_, run_->ground().state};
  }

  RunOptions options_{.folder = "stage_run", .command = "test"};
  fem::Mesh mesh_ = fem::make_rectangle(1, 1, 1, 1);
  std::optional<RunLog> log_;
  std::optional<GroundRun> run_;
  Stage stage_;
  fem::Increment increment_;
  std::vector<IncrementReport> recorded_;
};

/// Every number is another multiple of `n`, so that a sum over steps is the multiple of the sum of their n.
fem::NewtonReport report_of(int n, fem::NewtonStatus status) {
  fem::NewtonReport report;
  const auto count = static_cast<std::size_t>(n);
  report.status = status;
  report.iterations = 2 * n;
  report.evaluations = 3 * n;
  report.work = 5 * count;
  report.lane_steps = 7 * count;
  report.relaxations = 11 * n;
  report.viscous_work = 13 * n;
  report.times = {.material = 17.0 * n, .tangents = 47.0 * n, .assembly = 19.0 * n, .solve = 23.0 * n};
  report.material.open = 29 * count;
  report.material.step_limit = 31 * count;
  report.material.slowest_steps = 37 * n;
  report.material.deferral_error = 1.0 / n;
  report.material.deferred = 41 * count;
  report.largest_nodal_ratio = 43 * n;
  return report;
}

TEST_F(Steps, OfAnIncrementAreSummed) {
  StageRun stage(*run_, stage_);
  const fem::NewtonReport cut = report_of(1, fem::NewtonStatus::max_iterations);
  const fem::NewtonReport half = report_of(10, fem::NewtonStatus::converged);
  const fem::NewtonReport whole = report_of(100, fem::NewtonStatus::converged);
  stage.failed({0, 1, cut});
  EXPECT_TRUE(stage.converged(step(0, 0.5, false, half)));
  EXPECT_TRUE(recorded_.empty()) << "a step that reaches no target is no increment";
  EXPECT_TRUE(stage.converged(step(0.5, 1, true, whole)));
  ASSERT_EQ(recorded_.size(), 1U);
  EXPECT_EQ(stage.done(), 1);

  const io::IncrementInfo& info = recorded_[0].info;
  EXPECT_EQ(info.stage_index, 1);
  EXPECT_EQ(info.load_parameter, 1.0);
  EXPECT_EQ(info.cuts, 1);
  EXPECT_EQ(info.iterations, 2 * 111);
  EXPECT_EQ(info.evaluations, 3 * 111);
  EXPECT_EQ(info.particle_steps, 5.0 * 111);
  const EquilibriumReport& found = recorded_[0].equilibrium.value();
  EXPECT_EQ(found.relaxations, 11 * 111);
  EXPECT_EQ(found.time_grains, 17.0 * 111);
  EXPECT_EQ(found.time_tangents, 47.0 * 111);
  EXPECT_EQ(found.time_assembly, 19.0 * 111);
  EXPECT_EQ(found.time_solve, 23.0 * 111);
  EXPECT_EQ(found.viscous_work, 13.0 * 110) << "a step that did not converge has dissipated nothing";
  EXPECT_EQ(found.deferral_error, 1.0 / 10) << "the largest of the steps that converged";
}

TEST_F(Steps, StateAtTheEndIsThatOfTheLast) {
  StageRun stage(*run_, stage_);
  const fem::NewtonReport half = report_of(10, fem::NewtonStatus::converged);
  const fem::NewtonReport whole = report_of(1, fem::NewtonStatus::converged);
  EXPECT_TRUE(stage.converged(step(0, 0.5, false, half)));
  EXPECT_TRUE(stage.converged(step(0.5, 1, true, whole)));
  ASSERT_EQ(recorded_.size(), 1U);
  const EquilibriumReport& found = recorded_[0].equilibrium.value();
  EXPECT_EQ(found.open_points, 29U);
  EXPECT_EQ(found.step_limit_points, 31U);
  EXPECT_EQ(found.slowest_steps, 37);
  EXPECT_EQ(found.deferred_points, 41U);
  EXPECT_EQ(found.largest_nodal_ratio, 43.0);
}

// An increment is not called converged where RVEs that are not at rest may put its residual beyond the tolerance.
TEST_F(Steps, ThatRestlessRvesLeaveOpenAreNotConverged) {
  StageRun stage(*run_, stage_);
  const double tolerance = run_->settings().newton.tolerance;
  for (const double share : {0.5, 2.0}) {
    fem::NewtonReport report = report_of(1, fem::NewtonStatus::converged);
    report.residual_bound = tolerance;  // of a reference force of 1 N/m
    report.unsettled_force = share * tolerance;
    EXPECT_TRUE(stage.converged(step(0, share, true, report)));
    EXPECT_EQ(recorded_.back().info.converged, share < 1);
    report.material.step_limit = 0;
    EXPECT_TRUE(stage.converged(step(0, share, true, report)));
    EXPECT_TRUE(recorded_.back().info.converged);
  }
}

TEST_F(Steps, BeyondTheLawsRangeAreCountedOfGrainsOnly) {
  StageRun stage(*run_, stage_);
  fem::NewtonReport report = report_of(1, fem::NewtonStatus::converged);
  EXPECT_TRUE(stage.converged(step(0, 1, true, report)));
  EXPECT_FALSE(recorded_.back().equilibrium.value().out_of_range_points.has_value());
  report.material.mean_overlap = 0.05;
  report.material.out_of_range = 3;
  EXPECT_TRUE(stage.converged(step(1, 2, true, report)));
  EXPECT_EQ(recorded_.back().equilibrium.value().out_of_range_points, 3U);
  EXPECT_EQ(recorded_.back().equilibrium.value().mean_overlap, 0.05);
  EXPECT_EQ(run_->recorder().stage_totals().out_of_range_points, (std::vector<double>{3}));
}

TEST_F(Steps, OfTheNextIncrementAreCountedFromNothing) {
  StageRun stage(*run_, stage_);
  const fem::NewtonReport first = report_of(10, fem::NewtonStatus::converged);
  const fem::NewtonReport second = report_of(1, fem::NewtonStatus::converged);
  EXPECT_TRUE(stage.converged(step(0, 1, true, first)));
  EXPECT_TRUE(stage.converged(step(1, 2, true, second)));
  ASSERT_EQ(recorded_.size(), 2U);
  EXPECT_EQ(recorded_[1].info.iterations, 2);
  EXPECT_EQ(recorded_[1].info.evaluations, 3);
  EXPECT_EQ(recorded_[1].info.particle_steps, 5.0);
  EXPECT_EQ(recorded_[1].equilibrium.value().viscous_work, 13.0);
  const StageTotals& totals = run_->recorder().stage_totals();
  EXPECT_EQ(totals.evaluations, (std::vector<double>{30, 3}));
  EXPECT_EQ(totals.particle_steps, 55.0);
  EXPECT_EQ(totals.lane_steps, 77.0);
  EXPECT_EQ(totals.step_limit_points, (std::vector<double>{310, 31}));
}

}  // namespace
}  // namespace voussoir::host
