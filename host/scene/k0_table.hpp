#pragma once
/// K0, the ratio of horizontal to vertical stress at rest, as a function of the vertical stress.

#include <cstddef>
#include <string>
#include <vector>

namespace voussoir::host {

/// One averaged row of Gauss points of the column; compression positive.
struct K0Sample {
  double vertical = 0;  ///< vertical stress [Pa], > 0
  double ratio = 1;     ///< horizontal over vertical stress [-]
};

/// A smooth function K0(sigma_yy) that rises nowhere: knots in the logarithm of the stress, a monotone cubic between
/// them (Fritsch and Carlson 1980), constant outside.
class K0Table {
 public:
  /// A table with K0 = 1 at every stress.
  K0Table() = default;

  /// Fits a table to samples in any order: takes means over bins of equal width in log stress, then the nearest
  /// non-increasing sequence (pool adjacent violators). K0 is 1 at the initial stress [Pa] and below.
  [[nodiscard]] static K0Table fit(std::vector<K0Sample> samples, double initial_stress);

  /// A table with given knots [Pa], ascending, and their ratios, as a checkpoint stores them.
  K0Table(std::vector<double> stress, std::vector<double> ratio);

  /// K0 at a vertical stress [Pa], compression positive.
  [[nodiscard]] double at(double vertical) const;

  [[nodiscard]] const std::vector<double>& stress() const { return stress_; }
  [[nodiscard]] const std::vector<double>& ratio() const { return ratio_; }

 private:
  std::vector<double> stress_;  ///< [Pa]
  std::vector<double> ratio_;
  std::vector<double> log_stress_;
  std::vector<double> slope_;  ///< d ratio / d log stress at the knots
};

}  // namespace voussoir::host
