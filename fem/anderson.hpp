#pragma once
/// Anderson acceleration (type II; Walker & Ni 2011) of the fixed point u -> u + K^-1 R(u).

#include <deque>

#include "fem/sparse_solver.hpp"

namespace voussoir::fem {

class AndersonHistory {
 public:
  /// Keeps `depth` differences (0: no acceleration); `condition_limit` bounds the least squares (see `step`).
  AndersonHistory(int depth, double condition_limit) : depth_(depth), condition_limit_(condition_limit) {}

  /// Records an iterate and its residual.
  void add(const Eigen::VectorXd& u, const Eigen::VectorXd& residual);

  /// Forgets the differences; the last iterate stays as the base of the next.
  void restart() { differences_.clear(); }

  struct Step {
    Eigen::VectorXd newton;       ///< f = K^-1 R at the last iterate
    Eigen::VectorXd accelerated;  ///< f - (dU + dF) gamma, gamma = argmin |f - dF gamma|
  };

  /// The next step with the solver's present K. The history keeps differences of residuals, not old corrections, and
  /// dF = K^-1 dR is made anew from them, so that it stays consistent when K changes. That takes a few triangular
  /// solutions, which cost far less than one evaluation.
  [[nodiscard]] Step step(SparseSolver& solver) const;

 private:
  struct Difference {
    Eigen::VectorXd u;
    Eigen::VectorXd residual;
  };
  int depth_;
  double condition_limit_;
  Eigen::VectorXd u_;
  Eigen::VectorXd residual_;
  std::deque<Difference> differences_;  ///< newest first
};

}  // namespace voussoir::fem
