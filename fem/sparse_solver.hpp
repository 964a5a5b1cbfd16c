#pragma once
/// Direct solution of symmetric positive definite systems with CHOLMOD. The symbolic factorisation is made only once.

#include <Eigen/Dense>
#include <memory>
#include <vector>

namespace voussoir::fem {

/// Lower triangle by columns, row indices ascending within a column, every diagonal entry present.
struct SparsePattern {
  int n = 0;
  std::vector<int> column_start;  ///< n + 1
  std::vector<int> row;           ///< column_start[n]
};

enum class FactorStatus { ok, not_positive_definite, out_of_memory };

class SparseSolver {
 public:
  /// Orders and analyses the pattern. Throws std::runtime_error if CHOLMOD cannot.
  explicit SparseSolver(const SparsePattern& pattern);
  ~SparseSolver();
  SparseSolver(const SparseSolver&) = delete;
  SparseSolver& operator=(const SparseSolver&) = delete;

  /// Numeric factorisation of the matrix with these entries (one for each entry of the pattern).
  [[nodiscard]] FactorStatus factorise(const std::vector<double>& values);

  /// Solves for every column of `right_hand_sides`; needs a successful `factorise` before it.
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& right_hand_sides);

 private:
  struct Cholmod;
  std::unique_ptr<Cholmod> cholmod_;
};

}  // namespace voussoir::fem
