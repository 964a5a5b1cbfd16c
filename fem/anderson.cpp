#include "fem/anderson.hpp"

#include <algorithm>
#include <cmath>

namespace voussoir::fem {

namespace {

/// Minimises |f - D gamma| by QR of the columns of D, scaled to unit length, the newest first. From the first column on
/// whose part that newer columns do not span is below 1 / condition_limit, columns are dropped. Returns one gamma for
/// each column, zero for those dropped.
Eigen::VectorXd guarded_least_squares(const Eigen::MatrixXd& d, const Eigen::VectorXd& f, double condition_limit) {
  const Eigen::VectorXd lengths = d.colwise().norm();
  Eigen::VectorXd gamma = Eigen::VectorXd::Zero(d.cols());
  if (!(lengths.minCoeff() > 0)) return gamma;
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(d * lengths.cwiseInverse().asDiagonal());
  const Eigen::VectorXd diagonal = qr.matrixQR().diagonal().cwiseAbs();
  Eigen::Index kept = 0;
  while (kept < d.cols() && diagonal[kept] > 1 / condition_limit) ++kept;
  const Eigen::VectorXd rotated = qr.householderQ().transpose() * f;
  gamma.head(kept) = qr.matrixQR().topLeftCorner(kept, kept).triangularView<Eigen::Upper>().solve(rotated.head(kept));
  return gamma.cwiseQuotient(lengths);
}

}  // namespace

void AndersonHistory::add(const Eigen::VectorXd& u, const Eigen::VectorXd& residual) {
  if (u_.size() > 0 && depth_ > 0) {
    differences_.push_front({u - u_, residual - residual_});
    if (static_cast<int>(differences_.size()) > depth_) differences_.pop_back();
  }
  u_ = u;
  residual_ = residual;
}

AndersonHistory::Step AndersonHistory::step(SparseSolver& solver) const {
  const auto m = static_cast<Eigen::Index>(differences_.size());
  Eigen::MatrixXd right(residual_.size(), m + 1);
  Eigen::MatrixXd du(residual_.size(), m);
  right.col(0) = residual_;
  for (Eigen::Index k = 0; k < m; ++k) {
    du.col(k) = differences_[static_cast<std::size_t>(k)].u;
    right.col(k + 1) = differences_[static_cast<std::size_t>(k)].residual;
  }
  const Eigen::MatrixXd f = solver.solve(right);
  Step step{f.col(0), f.col(0)};
  if (m > 0 && f.allFinite()) {
    const Eigen::VectorXd gamma = guarded_least_squares(f.rightCols(m), step.newton, condition_limit_);
    step.accelerated -= (du + f.rightCols(m)) * gamma;
  }
  return step;
}

}  // namespace voussoir::fem
