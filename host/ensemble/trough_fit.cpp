#include "host/ensemble/trough_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace voussoir::host {
namespace {

constexpr int places = 15;            ///< of the grid, in each direction
constexpr int rounds = 25;            ///< each halves the grid's width
constexpr int first = 0, second = 1;  ///< ln i and ln alpha

/// n of eq. (21), chosen so that x = i is the inflection point.
double shape_number(double alpha) { return std::exp(alpha) * (2 * alpha - 1) / (2 * alpha + 1) + 1; }

/// The length that a place stands for: central differences, at both ends the distance to the neighbour.
std::vector<double> lengths_of(std::span<const double> x) {
  const std::size_t n = x.size();
  std::vector<double> length(n);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t before = k > 0 ? k - 1 : 0, after = std::min(k + 1, n - 1);
    length[k] = (x[after] - x[before]) / static_cast<double>(after - before);
  }
  return length;
}

/// The best S_max of a curve; the misfit of the result is the weighted sum of squares that it leaves.
TroughFit best_of(std::span<const double> x, std::span<const double> settlement, std::span<const double> length,
                  double inflection, double alpha, std::vector<double>& unit) {
  double product = 0, square = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    unit[k] = modified_gauss(x[k], 1.0, inflection, alpha);
    product += unit[k] * length[k] * settlement[k];
    square += unit[k] * unit[k] * length[k];
  }
  TroughFit found{.largest = product / std::max(square, 1e-300), .inflection = inflection, .alpha = alpha};
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double left = settlement[k] - found.largest * unit[k];
    found.misfit += left * left * length[k];
  }
  return found;
}

}  // namespace

bool TroughFit::good() const { return 1.05 * least_alpha < alpha && alpha < 0.95 * largest_alpha && misfit < 0.03; }

double modified_gauss(double x, double largest, double inflection, double alpha) {
  const double n = shape_number(alpha), ratio = x / inflection;
  return largest * n / (n - 1 + std::exp(std::min(alpha * ratio * ratio, 700.0)));
}

TroughFit fit_trough(std::span<const double> x, std::span<const double> settlement) {
  if (x.size() < 2 || x.size() != settlement.size()) throw std::invalid_argument("a trough needs at least two places");
  const std::vector<double> length = lengths_of(x);
  std::vector<double> unit(x.size());
  const std::array<double, 2> low{std::log(0.02 * x.back()), std::log(least_alpha)};
  const std::array<double, 2> high{std::log(2.0 * x.back()), std::log(largest_alpha)};
  std::array<double, 2> centre{}, half{};
  for (const int k : {first, second}) centre[k] = (low[k] + high[k]) / 2, half[k] = (high[k] - low[k]) / 2;
  const auto place = [&](int axis, int k) {
    const double along = centre[axis] - half[axis] + 2 * half[axis] * k / (places - 1);
    return std::exp(std::clamp(along, low[axis], high[axis]));
  };
  TroughFit best;
  for (int round = 0; round < rounds; ++round) {
    best.misfit = std::numeric_limits<double>::infinity();
    for (int row = 0; row < places; ++row) {
      for (int column = 0; column < places; ++column) {
        const TroughFit trial = best_of(x, settlement, length, place(first, column), place(second, row), unit);
        if (trial.misfit < best.misfit) best = trial;
      }
    }
    centre = {std::log(best.inflection), std::log(best.alpha)};
    for (double& width : half) width *= 0.5;
  }
  const double scale = best.largest != 0 ? std::abs(best.largest) : 1.0;
  best.misfit = std::sqrt(best.misfit / std::accumulate(length.begin(), length.end(), 0.0)) / scale;
  return best;
}

}  // namespace voussoir::host
