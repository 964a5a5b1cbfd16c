#include "host/case/accuracy.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/contact/engine_law.hpp"
#include "kernels/state/mobility.hpp"

namespace voussoir::host {

namespace {

constexpr std::size_t curve_points = 5;
constexpr std::array<double, curve_points> inertial_numbers{1e-4, 3e-4, 1e-3, 3e-3, 1e-2};

/// Errors at one pressure, by inertial number. Where chance made one at a lower pressure or a finer setting the other
/// way round, both have the larger error, so that no curve falls.
struct Curve {
  double inertial_time;                    ///< [steps]
  std::array<double, curve_points> error;  ///< over the pressure [-]
};

/// Root mean squares over packings of 300 grains at 800, 300, 100, 30, 10 and 1 kPa of the study's sand: of extension
/// (four packings), at 1 kPa of compression (four others; docs/validation/trade.md).
constexpr std::array<Curve, 6> curves{{{14.9, {0.00062, 0.00087, 0.0041, 0.0058, 0.0058}},
                                       {24.3, {0.00074, 0.0019, 0.0089, 0.0144, 0.0152}},
                                       {42.0, {0.00103, 0.0032, 0.0122, 0.0284, 0.0333}},
                                       {76.7, {0.0019, 0.0046, 0.0122, 0.0315, 0.0464}},
                                       {132.9, {0.0056, 0.0081, 0.0183, 0.0358, 0.0539}},
                                       {420.3, {0.024, 0.028, 0.030, 0.047, 0.074}}}};

/// Errors of paths of simple shear, which made no curve, were up to 1.6 times what the curves give.
constexpr double margin = 1.7;

/// Where `x` lies between two neighbours of an ascending row: the first of them, and the share of the way to the
/// second, in logarithms. The share is negative before the row and above 1 behind it.
struct Place {
  std::size_t first;
  double share;
};

template <class Row, class Value>
Place place_in(const Row& row, const Value& value_of, double x) {
  std::size_t k = 0;
  while (k + 2 < row.size() && value_of(row[k + 1]) < x) ++k;
  const double low = value_of(row[k]), high = value_of(row[k + 1]);
  return {k, std::log(x / low) / std::log(high / low)};
}

double between(double low, double high, double share) { return low * std::pow(high / low, share); }

/// The curve at an inertial time, with the margin. Below the lowest pressure all errors go on growing as the one of the
/// smallest inertial number does between the two lowest ones, which is the fastest; above the highest one they stay.
std::array<double, curve_points> curve_at(double inertial_time) {
  const Place at = place_in(curves, [](const Curve& curve) { return curve.inertial_time; }, inertial_time);
  const double share = std::clamp(at.share, 0.0, 1.0);
  const double beyond = std::max(at.share - 1.0, 0.0);
  const auto& last = curves[curves.size() - 1].error;
  const auto& before_last = curves[curves.size() - 2].error;
  const double growth = std::pow(last.front() / before_last.front(), beyond);
  std::array<double, curve_points> errors{};
  for (std::size_t k = 0; k < curve_points; ++k)
    errors[k] = margin * growth * between(curves[at.first].error[k], curves[at.first + 1].error[k], share);
  return errors;
}

}  // namespace

double expected_error(double inertial_number, double inertial_time) {
  const auto errors = curve_at(inertial_time);
  const Place at = place_in(inertial_numbers, [](double x) { return x; }, inertial_number);
  return between(errors[at.first], errors[at.first + 1], std::clamp(at.share, 0.0, 1.0));
}

AccuracyChoice choose_inertial_number(double accuracy, double inertial_time) {
  const auto errors = curve_at(inertial_time);
  if (accuracy <= errors.front()) return {inertial_numbers.front(), errors.front()};
  if (accuracy >= errors.back()) return {inertial_numbers.back(), errors.back()};
  std::size_t k = curve_points - 2;
  while (errors[k] > accuracy) --k;
  const double share = std::log(accuracy / errors[k]) / std::log(errors[k + 1] / errors[k]);
  return {between(inertial_numbers[k], inertial_numbers[k + 1], share), accuracy};
}

double inertial_number_at(double inertial_time, const EngineCase& engine) {
  return engine.accuracy > 0 ? choose_inertial_number(engine.accuracy, inertial_time).inertial_number
                             : engine.inertial_number;
}

double inertial_time_of(const SoilCase& soil, double pressure) {
  const kernels::GrainMaterial grain{.modulus = soil.modulus, .stiffness_ratio = soil.stiffness_ratio};
  const double mean_radius = 0.25 * (soil.size_minimum + soil.size_maximum);
  const kernels::Mobility mobility = kernels::mobility_of<kernels::PlainEngineLaw>(
      grain, mean_radius, 0.5 * soil.size_maximum, kernels::EngineSettings{}.overlap_limit);
  return kernels::inertial_time(mobility.translation, soil.thickness, pressure);
}

void apply_accuracy(EngineCase& engine) {
  constexpr double fine = 0.005;
  engine.hold_tolerance = engine.accuracy < fine ? 3e-4 : 1e-3;
  engine.minimum_steps = engine.accuracy < fine ? 50 : 20;
  engine.maximum_steps = 1'000'000;
}

std::string accuracy_note(const EngineCase& engine, const SoilCase& soil) {
  const double accuracy = engine.accuracy;
  std::string text = fmt::format("engine accuracy {:g} % of the mean stress:", 100 * accuracy);
  if (!soil.classes.empty() || !soil.sizes.empty())
    return text +
           " the field expected_error shows where it cannot be met (docs/validation/trade.md; measured on one class of "
           "grains)";
  const char* separator = " ";
  for (const double kpa : {1.0, 10.0, 100.0, 800.0}) {
    const AccuracyChoice choice = choose_inertial_number(accuracy, inertial_time_of(soil, 1e3 * kpa));
    text += fmt::format("{}inertial number {:.1e} at {:g} kPa", separator, choice.inertial_number, kpa);
    if (choice.error > accuracy)
      text += fmt::format(" (which leaves {:.2g} %, because a path there does not repeat better)", 100 * choice.error);
    separator = ", ";
  }
  if (engine.hold_cap < EngineCase{}.hold_cap)
    text += fmt::format("; measured with holds of up to {} steps", EngineCase{}.hold_cap);
  return text + " (docs/validation/trade.md)";
}

}  // namespace voussoir::host
