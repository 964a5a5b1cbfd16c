#include "host/ensemble/bands.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "host/ensemble/student.hpp"

namespace voussoir::host {

BandRule band_rule(int members) {
  if (members < 2) throw std::invalid_argument("bands need at least two members");
  BandRule rule{.members = members};
  rule.student_t = student_two_sided(rule.confidence, members - 1);
  rule.mean_factor = rule.student_t / std::sqrt(static_cast<double>(members));
  rule.prediction_factor = rule.student_t * std::sqrt(1.0 + 1.0 / members);
  return rule;
}

void BandSums::add(std::span<const double> values) {
  if (values.size() != mean_.size()) throw std::invalid_argument("the members' arrays have different lengths");
  ++count_;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double before = values[k] - mean_[k];
    mean_[k] += before / count_;
    squares_[k] += before * (values[k] - mean_[k]);
  }
}

io::Bands BandSums::bands(const BandRule& rule, std::string name, std::string unit,
                          std::vector<std::size_t> shape) const {
  if (count_ != rule.members) throw std::invalid_argument("the bands' rule is for another number of members");
  io::Bands found{.name = std::move(name), .unit = std::move(unit), .shape = std::move(shape), .mean = mean_};
  for (const double squares : squares_) {
    const double deviation = std::sqrt(squares / (count_ - 1));
    found.deviation.push_back(deviation);
    found.mean_half_width.push_back(rule.mean_factor * deviation);
    found.prediction_half_width.push_back(rule.prediction_factor * deviation);
  }
  return found;
}

io::Bands bands_of(const std::vector<std::vector<double>>& members, const BandRule& rule, std::string name,
                   std::string unit, std::vector<std::size_t> shape) {
  BandSums sums(members.empty() ? 0 : members.front().size());
  for (const std::vector<double>& values : members) sums.add(values);
  io::Bands found = sums.bands(rule, std::move(name), std::move(unit), std::move(shape));
  for (const std::vector<double>& values : members)
    found.members.insert(found.members.end(), values.begin(), values.end());
  return found;
}

}  // namespace voussoir::host
