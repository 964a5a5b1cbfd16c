#pragma once
/// The search of `kind = "calibrate"`: a grid of parameters, a quadratic response surface through the measurements on
/// this grid, and the places to measure next. This file knows no grains: calibrate_tests.hpp makes the measurements.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "host/case/case.hpp"

namespace voussoir::host {

/// The grains' open parameters, which are keys of [soil]; classes of grains keep their ratios to [soil].
struct Parameter {
  enum Index : std::size_t { rolling_stiffness, rolling_limit, thickness, count };
};
using ParameterSet = std::array<double, Parameter::count>;  ///< beta [-], eta [-], t [m]

/// Quantities of the tests that are compared with Table 2.
struct Observable {
  enum Index : std::size_t { peak_angle, critical_angle, dilatancy_angle, peak_strain, count };
};
using Observation = std::array<double, Observable::count>;  ///< [rad], [rad], [rad], [-]

struct Measured {
  ParameterSet set{};
  Observation value{};
};

/// Sum of squared differences from the targets, each over its tolerance. A peak strain within its limits adds nothing.
[[nodiscard]] double misfit(const Observation& value, const CalibrateCase& targets);

/// The box that is searched: from the smallest to the largest value of each list. Its coordinates are linear in the
/// logarithm of the values.
class SearchBox {
 public:
  /// A parameter with an empty list keeps the value of `soil`; a list of one value fixes the parameter at this value.
  SearchBox(const CalibrateCase& lists, const SoilCase& soil);

  [[nodiscard]] std::size_t dimensions() const { return searched_.size(); }
  [[nodiscard]] Parameter::Index parameter(std::size_t dimension) const { return searched_[dimension]; }
  /// Spacing of the grid, 1 / (values - 1).
  [[nodiscard]] double spacing(std::size_t dimension) const {
    return 1.0 / static_cast<double>(lists_[searched_[dimension]].size() - 1);
  }

  /// All combinations of the lists.
  [[nodiscard]] std::vector<ParameterSet> grid() const;

  /// Coordinates of a set in [0, 1], one per dimension. set_at is the inverse; it moves a place outside to the box's
  /// side.
  [[nodiscard]] std::vector<double> place_of(const ParameterSet& set) const;
  [[nodiscard]] ParameterSet set_at(std::span<const double> place) const;

 private:
  std::array<std::vector<double>, Parameter::count> lists_;
  std::vector<Parameter::Index> searched_;
  ParameterSet fixed_{};
};

/// Weighted least-squares quadratics, one per observable, over places of a box.
class ResponseSurface {
 public:
  /// Fits the surface near `center`; the weights fall off over the distance `range`. With fewer points than
  /// coefficients the solution with the smallest coefficients is taken.
  ResponseSurface(const SearchBox& box, std::span<const Measured> points, std::span<const double> center, double range);

  [[nodiscard]] Observation at(std::span<const double> place) const;
  /// Weighted root mean square of the difference between measurements and surface.
  [[nodiscard]] const Observation& scatter() const { return scatter_; }

 private:
  std::vector<Observation> coefficients_;
  Observation scatter_{};
};

/// The optimum of the surface through all measurements after `round` refinements.
struct Optimum {
  ParameterSet set{};
  Observation scatter{};
  std::array<Observation, Parameter::count> per_doubling{};  ///< change of the observables when a parameter doubles; 0
                                                             ///< when not searched
};
[[nodiscard]] Optimum find_optimum(const SearchBox& box, std::span<const Measured> points, const CalibrateCase& targets,
                                   int round);

/// The sets that the next round measures: the optimum, and one step to either side along each dimension. Each round
/// halves the step.
[[nodiscard]] std::vector<ParameterSet> around(const SearchBox& box, const ParameterSet& center, int round);

/// The soil with another parameter set.
[[nodiscard]] SoilCase with_parameters(SoilCase soil, const ParameterSet& set);
[[nodiscard]] ParameterSet parameters_of(const SoilCase& soil);

}  // namespace voussoir::host
