#include <gtest/gtest.h>

#include "fem/anderson.hpp"

namespace voussoir::fem {
namespace {

/// K: the identity on three unknowns, so that a correction is the residual itself.
SparseSolver identity() { return SparseSolver({.n = 3, .column_start = {0, 1, 2, 3}, .row = {0, 1, 2}}); }

TEST(Anderson, SolvesALinearSystemInAsManyStepsAsUnknowns) {
  SparseSolver solver = identity();
  ASSERT_EQ(solver.factorise({1, 1, 1}), FactorStatus::ok);
  Eigen::Matrix3d a;  // the true stiffness, far from K
  a << 0.4, 0.1, 0, 0.1, 0.2, 0.05, 0, 0.05, 0.7;
  const Eigen::Vector3d b(1, -2, 3);
  AndersonHistory history(5, 1e10);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(3);
  for (int k = 0; k < 4; ++k) {
    history.add(u, b - a * u);
    u += history.step(solver).accelerated;
  }
  EXPECT_LT((a * u - b).norm(), 1e-12);
}

TEST(Anderson, WithoutHistoryTheStepIsNewtons) {
  SparseSolver solver = identity();
  ASSERT_EQ(solver.factorise({2, 2, 2}), FactorStatus::ok);
  AndersonHistory history(5, 1e6);
  const Eigen::Vector3d residual(1, 2, 4);
  history.add(Eigen::Vector3d(5, 5, 5), residual);
  EXPECT_LT((history.step(solver).accelerated - 0.5 * residual).norm(), 1e-14);
  history.add(Eigen::Vector3d(6, 6, 6), 0.3 * residual);
  EXPECT_GT((history.step(solver).accelerated - history.step(solver).newton).norm(), 0.01);
  history.restart();
  EXPECT_LT((history.step(solver).accelerated - 0.15 * residual).norm(), 1e-14);
}

TEST(Anderson, OldDifferencesThatSayNothingNewAreDropped) {
  SparseSolver solver = identity();
  ASSERT_EQ(solver.factorise({1, 1, 1}), FactorStatus::ok);
  const Eigen::Vector3d start(1, 1, 1), du(0.1, 0.2, 0), change(-0.4, 0.1, 0.2);
  AndersonHistory one(5, 1e6), two(5, 1e6);
  // In `two` the older difference has the same change of residual but for 1e-9, and a wildly different displacement.
  two.add(start - du - Eigen::Vector3d(7, 0, 0), start - 2 * change - Eigen::Vector3d(0, 0, 1e-9));
  for (AndersonHistory* history : {&one, &two}) {
    history->add(start - du, start - change);
    history->add(start, start);
  }
  EXPECT_LT((one.step(solver).accelerated - two.step(solver).accelerated).norm(), 1e-14);
}

}  // namespace
}  // namespace voussoir::fem
