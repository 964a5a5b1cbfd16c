#include "host/scene/k0_table.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <utility>

namespace voussoir::host {
namespace {

constexpr double bins_per_decade = 12;

struct Knot {
  double log_stress = 0;
  double ratio = 1;
  double weight = 1;
};

/// Means of the samples over bins of equal width in log stress; empty bins give no knot.
std::vector<Knot> bin(std::vector<K0Sample>& samples, double initial_stress) {
  std::sort(samples.begin(), samples.end(),
            [](const K0Sample& a, const K0Sample& b) { return a.vertical < b.vertical; });
  const double width = std::log(10.0) / bins_per_decade;
  const double origin = std::log(initial_stress);
  std::vector<Knot> knots;
  double open_bin = -1;
  for (const K0Sample& sample : samples) {
    const double position = std::log(sample.vertical);
    const double index = std::floor((position - origin) / width);
    if (index < 0 || sample.vertical <= initial_stress) continue;  // K0 is set to 1 there
    if (knots.empty() || index != open_bin) {
      knots.push_back({0, 0, 0});
      open_bin = index;
    }
    knots.back().log_stress += position;
    knots.back().ratio += sample.ratio;
    knots.back().weight += 1;
  }
  for (Knot& knot : knots) {
    knot.log_stress /= knot.weight;
    knot.ratio /= knot.weight;
  }
  return knots;
}

/// The non-increasing sequence nearest to the knots' ratios in weighted least squares (pool adjacent violators).
void make_non_increasing(std::vector<Knot>& knots) {
  struct Block {
    double ratio;
    double weight;
    std::size_t count;
  };
  std::vector<Block> blocks;
  for (const Knot& knot : knots) {
    blocks.push_back({std::min(knot.ratio, 1.0), knot.weight, 1});
    while (blocks.size() > 1 && blocks[blocks.size() - 2].ratio < blocks.back().ratio) {
      const Block last = blocks.back();
      blocks.pop_back();
      Block& into = blocks.back();
      into.ratio = (into.ratio * into.weight + last.ratio * last.weight) / (into.weight + last.weight);
      into.weight += last.weight;
      into.count += last.count;
    }
  }
  std::size_t next = 0;
  for (const Block& block : blocks) {
    for (std::size_t k = 0; k < block.count; ++k) knots[next++].ratio = block.ratio;
  }
}

/// Slopes that keep a cubic Hermite interpolant monotone: the weighted harmonic mean of the secants (Fritsch and
/// Butland 1984), zero where the secants change sign. The slopes at the ends are one-sided.
std::vector<double> monotone_slopes(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<double> slope(x.size(), 0.0);
  if (x.size() < 2) return slope;
  const auto secant = [&](std::size_t k) { return (y[k + 1] - y[k]) / (x[k + 1] - x[k]); };
  slope.front() = secant(0);
  slope.back() = secant(x.size() - 2);
  for (std::size_t k = 1; k + 1 < x.size(); ++k) {
    const double before = secant(k - 1);
    const double after = secant(k);
    if (before * after <= 0) continue;
    const double h0 = x[k] - x[k - 1];
    const double h1 = x[k + 1] - x[k];
    slope[k] = 3 * (h0 + h1) / ((2 * h1 + h0) / before + (h1 + 2 * h0) / after);
  }
  return slope;
}

}  // namespace

K0Table::K0Table(std::vector<double> stress, std::vector<double> ratio)
    : stress_(std::move(stress)), ratio_(std::move(ratio)) {
  assert(stress_.size() == ratio_.size());
  log_stress_.resize(stress_.size());
  std::transform(stress_.begin(), stress_.end(), log_stress_.begin(), [](double s) { return std::log(s); });
  slope_ = monotone_slopes(log_stress_, ratio_);
}

K0Table K0Table::fit(std::vector<K0Sample> samples, double initial_stress) {
  std::erase_if(samples, [](const K0Sample& s) { return !(s.vertical > 0) || !std::isfinite(s.ratio); });
  std::vector<Knot> knots = bin(samples, initial_stress);
  make_non_increasing(knots);
  std::vector<double> stress{initial_stress};
  std::vector<double> ratio{1.0};
  for (const Knot& knot : knots) {
    stress.push_back(std::exp(knot.log_stress));
    ratio.push_back(knot.ratio);
  }
  return {std::move(stress), std::move(ratio)};
}

double K0Table::at(double vertical) const {
  if (stress_.empty()) return 1.0;
  if (!(vertical > stress_.front())) return ratio_.front();
  if (vertical >= stress_.back()) return ratio_.back();
  const auto upper = std::upper_bound(stress_.begin(), stress_.end(), vertical);
  const auto k = static_cast<std::size_t>(upper - stress_.begin()) - 1;
  const double h = log_stress_[k + 1] - log_stress_[k];
  const double s = (std::log(vertical) - log_stress_[k]) / h;
  const double s2 = s * s;
  const double s3 = s2 * s;
  return ratio_[k] * (2 * s3 - 3 * s2 + 1) + h * slope_[k] * (s3 - 2 * s2 + s) + ratio_[k + 1] * (3 * s2 - 2 * s3) +
         h * slope_[k + 1] * (s3 - s2);
}

}  // namespace voussoir::host
