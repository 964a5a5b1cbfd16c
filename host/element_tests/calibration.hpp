#pragma once
/// The search behind `kind = "calibrate"`: a grid of parameters, a quadratic response surface through the measurements
/// on it, and the places to measure next. No grains are in here: the measurements come from calibrate_tests.hpp.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "host/case/case.hpp"

namespace voussoir::host {

/// The open parameters of method.md §3, those of [soil]; classes of grains keep their ratios to them.
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

/// Sum of squared differences from the targets over their tolerances; within its limits the peak strain adds nothing.
[[nodiscard]] double misfit(const Observation& value, const CalibrateCase& targets);

/// The box that is searched: between the smallest and the largest value of each list, even in the logarithm.
class SearchBox {
 public:
  /// Lists of fewer than two values leave their parameter as `soil` has it.
  SearchBox(const CalibrateCase& lists, const SoilCase& soil);

  [[nodiscard]] std::size_t dimensions() const { return searched_.size(); }
  [[nodiscard]] Parameter::Index parameter(std::size_t dimension) const { return searched_[dimension]; }
  /// Spacing of the grid, 1 / (values - 1).
  [[nodiscard]] double spacing(std::size_t dimension) const {
    return 1.0 / static_cast<double>(lists_[searched_[dimension]].size() - 1);
  }

  /// All combinations of the lists.
  [[nodiscard]] std::vector<ParameterSet> grid() const;

  /// Coordinates in [0, 1] of a set, one per dimension, and back (a place outside is moved to the box's side).
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
  /// Near `center`, where weights fall off over `range`. With fewer points than coefficients the smallest coefficients
  /// are taken.
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
  std::array<Observation, Parameter::count> per_doubling{};  ///< change of the observables when a parameter doubles; 0:
                                                             ///< not searched
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
