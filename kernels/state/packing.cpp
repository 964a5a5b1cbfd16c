#include "kernels/state/packing.hpp"

#include <algorithm>
#include <numbers>
#include <numeric>

#include "kernels/state/mobility.hpp"
#include "kernels/state/requests.hpp"

namespace voussoir::kernels {

double Packing::mean_diameter() const {
  return 2.0 * std::accumulate(radii.begin(), radii.end(), 0.0) / static_cast<double>(radii.size());
}

double Packing::largest_radius() const { return *std::max_element(radii.begin(), radii.end()); }

double Packing::solid_area() const {
  double sum = 0;
  for (const double r : radii) sum += std::numbers::pi * r * r;
  return sum;
}

double Packing::inertial_time(double pressure) const {
  return kernels::inertial_time(mean_mobility<PlainEngineLaw>(*this, EngineSettings{}.overlap_limit), thickness,
                                pressure);
}

bool rolls(std::span<const Packing> packings) {
  return std::any_of(packings.begin(), packings.end(), [](const Packing& p) {
    return std::any_of(p.materials.begin(), p.materials.end(),
                       [](const GrainMaterial& m) { return m.rolling_stiffness > 0 && m.rolling_limit > 0; });
  });
}

}  // namespace voussoir::kernels
