#include "host/element_tests/calibration.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace voussoir::host {

namespace {

double squared(double x) { return x * x; }

/// The monomials 1, x_i and x_i x_j at a place.
Eigen::VectorXd monomials(std::span<const double> place) {
  std::vector<double> out{1.0};
  for (std::size_t i = 0; i < place.size(); ++i) {
    out.push_back(place[i]);
    for (std::size_t j = 0; j <= i; ++j) out.push_back(place[i] * place[j]);
  }
  return Eigen::Map<Eigen::VectorXd>(out.data(), static_cast<Eigen::Index>(out.size()));
}

/// Calls body(place) for each place of an even lattice over the box with `side` places along each dimension.
template <class Body>
void for_each_place(std::size_t dimensions, int side, const Body& body) {
  std::vector<int> at(dimensions, 0);
  std::vector<double> place(dimensions, 0.0);
  while (true) {
    for (std::size_t d = 0; d < dimensions; ++d) place[d] = at[d] / (side - 1.0);
    body(place);
    std::size_t d = 0;
    while (d < dimensions && ++at[d] == side) at[d++] = 0;
    if (d == dimensions) return;
  }
}

double distance_squared(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t d = 0; d < a.size(); ++d) sum += squared(a[d] - b[d]);
  return sum;
}

/// The place of the box with the least expected misfit, no farther than `reach` from `center`.
std::vector<double> lowest(const SearchBox& box, const ResponseSurface& surface, const CalibrateCase& targets,
                           const std::vector<double>& center, double reach) {
  std::vector<double> best = center;
  double least = std::numeric_limits<double>::infinity();
  for_each_place(box.dimensions(), 41, [&](const std::vector<double>& place) {
    if (distance_squared(place, center) > reach * reach) return;
    const double here = misfit(surface.at(place), targets);
    if (here < least) {
      least = here;
      best = place;
    }
  });
  return best;
}

}  // namespace

double misfit(const Observation& value, const CalibrateCase& targets) {
  const auto off = [](double x, const CalibrationTarget& target) {
    return squared((x - target.value) / target.tolerance);
  };
  const double strain = std::max({targets.peak_strain_minimum - value[Observable::peak_strain],
                                  value[Observable::peak_strain] - targets.peak_strain_maximum, 0.0});
  return off(value[Observable::peak_angle], targets.peak) + off(value[Observable::critical_angle], targets.critical) +
         off(value[Observable::dilatancy_angle], targets.dilatancy) + squared(strain / targets.peak_strain_tolerance);
}

SearchBox::SearchBox(const CalibrateCase& lists, const SoilCase& soil)
    : lists_{lists.rolling_stiffness, lists.rolling_limit, lists.thickness}, fixed_(parameters_of(soil)) {
  for (std::size_t p = 0; p < Parameter::count; ++p) {
    if (lists_[p].size() == 1) fixed_[p] = lists_[p].front();
    if (lists_[p].size() > 1) searched_.push_back(static_cast<Parameter::Index>(p));
  }
}

std::vector<ParameterSet> SearchBox::grid() const {
  std::vector<ParameterSet> sets{fixed_};
  for (const Parameter::Index p : searched_) {
    std::vector<ParameterSet> more;
    for (const ParameterSet& set : sets) {
      for (const double value : lists_[p]) {
        more.push_back(set);
        more.back()[p] = value;
      }
    }
    sets = std::move(more);
  }
  return sets;
}

std::vector<double> SearchBox::place_of(const ParameterSet& set) const {
  std::vector<double> place;
  for (const Parameter::Index p : searched_) {
    const auto& list = lists_[p];
    place.push_back(std::log(set[p] / list.front()) / std::log(list.back() / list.front()));
  }
  return place;
}

ParameterSet SearchBox::set_at(std::span<const double> place) const {
  ParameterSet set = fixed_;
  for (std::size_t d = 0; d < searched_.size(); ++d) {
    const auto& list = lists_[searched_[d]];
    set[searched_[d]] = list.front() * std::pow(list.back() / list.front(), std::clamp(place[d], 0.0, 1.0));
  }
  return set;
}

ResponseSurface::ResponseSurface(const SearchBox& box, std::span<const Measured> points, std::span<const double> center,
                                 double range) {
  const auto n = static_cast<Eigen::Index>(points.size());
  const Eigen::Index size = monomials(center).size();
  Eigen::MatrixXd rows(n, size), values(n, static_cast<Eigen::Index>(Observable::count));
  Eigen::VectorXd weights(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Measured& point = points[static_cast<std::size_t>(k)];
    const std::vector<double> place = box.place_of(point.set);
    // The row is multiplied by this factor, so that the square of the factor is the weight of its residual.
    weights(k) = std::exp(-0.25 * distance_squared(place, center) / (range * range));
    rows.row(k) = weights(k) * monomials(place).transpose();
    for (std::size_t o = 0; o < Observable::count; ++o)
      values(k, static_cast<Eigen::Index>(o)) = weights(k) * point.value[o];
  }
  const Eigen::MatrixXd solution = rows.completeOrthogonalDecomposition().solve(values);
  const Eigen::MatrixXd left = values - rows * solution;
  coefficients_.resize(static_cast<std::size_t>(size));
  for (std::size_t o = 0; o < Observable::count; ++o) {
    const auto column = static_cast<Eigen::Index>(o);
    for (Eigen::Index c = 0; c < size; ++c) coefficients_[static_cast<std::size_t>(c)][o] = solution(c, column);
    scatter_[o] = left.col(column).norm() / weights.norm();
  }
}

Observation ResponseSurface::at(std::span<const double> place) const {
  const Eigen::VectorXd m = monomials(place);
  Observation out{};
  for (std::size_t c = 0; c < coefficients_.size(); ++c) {
    for (std::size_t o = 0; o < Observable::count; ++o) out[o] += m(static_cast<Eigen::Index>(c)) * coefficients_[c][o];
  }
  return out;
}

Optimum find_optimum(const SearchBox& box, std::span<const Measured> points, const CalibrateCase& targets, int round) {
  const double range = std::max(0.5 * std::pow(0.5, round), 0.2);
  const auto worse = [&](const Measured& a, const Measured& b) {
    return misfit(a.value, targets) < misfit(b.value, targets);
  };
  std::vector<double> center = box.place_of(std::min_element(points.begin(), points.end(), worse)->set);
  // Done twice: the best point may be best by chance; the surface around it takes its neighbours into account.
  for (int k = 0; k < 2; ++k) center = lowest(box, ResponseSurface(box, points, center, range), targets, center, range);
  const ResponseSurface surface(box, points, center, range);
  Optimum best{.set = box.set_at(center), .scatter = surface.scatter()};
  for (std::size_t d = 0; d < box.dimensions(); ++d) {
    constexpr double side = 0.05;
    std::vector<double> low = center, high = center;
    low[d] -= side;
    high[d] += side;
    std::vector<double> inner(center), outer(center);
    inner[d] = 0, outer[d] = 1;
    const Parameter::Index p = box.parameter(d);
    const double doublings = 2 * side * std::log2(box.set_at(outer)[p] / box.set_at(inner)[p]);
    for (std::size_t o = 0; o < Observable::count; ++o) {
      best.per_doubling[p][o] = (surface.at(high)[o] - surface.at(low)[o]) / doublings;
    }
  }
  return best;
}

std::vector<ParameterSet> around(const SearchBox& box, const ParameterSet& center, int round) {
  std::vector<ParameterSet> sets{center};
  const std::vector<double> middle = box.place_of(center);
  for (std::size_t d = 0; d < box.dimensions(); ++d) {
    const double step = box.spacing(d) * std::pow(0.5, round);
    for (const double to : {-step, step}) {
      std::vector<double> place = middle;
      place[d] += to;
      if (place[d] >= 0 && place[d] <= 1) sets.push_back(box.set_at(place));
    }
  }
  return sets;
}

SoilCase with_parameters(SoilCase soil, const ParameterSet& set) {
  const auto ratio = [](double to, double from) { return from > 0 ? to / from : 1.0; };
  for (GrainClassCase& grains : soil.classes) {
    grains.rolling_stiffness *= ratio(set[Parameter::rolling_stiffness], soil.rolling_stiffness);
    grains.rolling_limit *= ratio(set[Parameter::rolling_limit], soil.rolling_limit);
  }
  soil.rolling_stiffness = set[Parameter::rolling_stiffness];
  soil.rolling_limit = set[Parameter::rolling_limit];
  soil.thickness = set[Parameter::thickness];
  return soil;
}

ParameterSet parameters_of(const SoilCase& soil) {
  return {soil.rolling_stiffness, soil.rolling_limit, soil.thickness};
}

}  // namespace voussoir::host
