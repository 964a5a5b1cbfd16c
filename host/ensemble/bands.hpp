#pragma once
/// Mean, standard deviation and bands of arrays of numbers over the members of an ensemble.

#include <span>
#include <string>
#include <vector>

#include "io/ensemble_file.hpp"

namespace voussoir::host {

/// The rule of both bands for `members` members: mean +- factor * deviation.
struct BandRule {
  int members = 0;
  double confidence = 0.95;
  double student_t = 0;
  double mean_factor = 0;        ///< t / sqrt(n): where the mean of infinitely many members lies
  double prediction_factor = 0;  ///< t sqrt(1 + 1/n): where one further member lies
};

/// Throws std::invalid_argument for fewer than two members, which show no scatter.
[[nodiscard]] BandRule band_rule(int members);

/// Sums of arrays that come one after another, so that two arrays are in memory and not one for each member. The
/// running mean and sum of squares are Welford's, which lose no digits where the scatter is small beside the mean.
class BandSums {
 public:
  explicit BandSums(std::size_t size) : mean_(size, 0.0), squares_(size, 0.0) {}

  /// Adds the array of one member. What is not a number there makes the mean and the bands of its place not a number.
  void add(std::span<const double> values);
  /// Throws std::invalid_argument unless as many arrays were added as the rule speaks of.
  [[nodiscard]] io::Bands bands(const BandRule& rule, std::string name, std::string unit,
                                std::vector<std::size_t> shape) const;

 private:
  int count_ = 0;
  std::vector<double> mean_;
  std::vector<double> squares_;  ///< sum of the squared differences from the mean
};

/// Bands of arrays of equal lengths, one a member; the arrays are kept in Bands::members.
[[nodiscard]] io::Bands bands_of(const std::vector<std::vector<double>>& members, const BandRule& rule,
                                 std::string name, std::string unit, std::vector<std::size_t> shape);

}  // namespace voussoir::host
