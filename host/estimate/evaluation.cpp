#include "host/estimate/evaluation.hpp"

#include <algorithm>

#include "host/case/accuracy.hpp"
#include "host/packing/grading.hpp"

namespace voussoir::host {
namespace {

constexpr double hold_steps = 30;

}  // namespace

double inertial_steps(const SoilCase& soil, double strain, double pressure, double inertial_number) {
  return strain / inertial_number * inertial_time_of(soil, pressure);
}

double steps_per_evaluation(const SoilCase& soil, const EngineCase& engine, double strain, double pressure) {
  const double steps = inertial_steps(soil, strain, pressure,
                                      inertial_number_at(inertial_time_of(soil, pressure), engine));
  return std::clamp(steps, static_cast<double>(engine.minimum_steps), static_cast<double>(engine.maximum_steps)) +
         std::min(hold_steps, static_cast<double>(engine.hold_cap));
}

}  // namespace voussoir::host
