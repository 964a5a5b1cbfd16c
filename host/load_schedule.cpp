#include "host/load_schedule.hpp"

#include <algorithm>

namespace voussoir::host {

LoadSchedule::LoadSchedule(const GravityCase& gravity, double initial_stress, double base_weight)
    : growth_(gravity.ratio - 1.0), initial_factor_(initial_stress / base_weight), uniform_step_(gravity.uniform_step) {}

double LoadSchedule::next(double lambda) const {
  const double step = std::min(growth_ * (initial_factor_ + lambda), uniform_step_);
  const double to = lambda + step;
  // A last crumb of less than half a step is taken together with the step before it.
  return to + 0.5 * step > 1.0 ? 1.0 : to;
}

int LoadSchedule::count() const {
  int increments = 0;
  for (double lambda = 0; lambda < 1.0; lambda = next(lambda)) ++increments;
  return increments;
}

}  // namespace voussoir::host
