#include "host/packing/bias.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/advance_rves.hpp"

namespace voussoir::host {

namespace {

// Biases are stored with the packings, so that a change of this test must raise recipe_version (recipe.cpp).
constexpr double oedometric_end = 700.0e3;       ///< vertical stress of the deepest ground of the study [Pa]
constexpr double oedometric_increment = 1.0e-3;  ///< axial strain [-]
constexpr int most_increments = 200;
constexpr double bias_floor = 20.0e3;  ///< at less pressure tau_xy comes from the consolidation [Pa]

/// One increment of the oedometric test.
struct OedometricPoint {
  double stress_yy, stress_xy;  ///< compression-positive stresses [Pa]
};

/// Compresses all packings in one batch; returns one curve for each of them.
std::vector<std::vector<OedometricPoint>> oedometric_tests(std::span<const PackedRve> rves) {
  std::vector<std::vector<OedometricPoint>> curves(rves.size());
  if (rves.empty()) return curves;
  kernels::RveBatch batch = batch_of(rves);
  const kernels::EngineSettings settings{.precision = kernels::Precision::float64};
  std::vector<kernels::RveReport> reports(rves.size());
  std::vector<char> ended(rves.size(), 0);
  for (int increment = 0; increment < most_increments && std::count(ended.begin(), ended.end(), 0) > 0; ++increment) {
    const double strain = increment < 4 ? 0.25 * oedometric_increment : oedometric_increment;  // small steps at first,
                                                                                               // while the packing is
                                                                                               // soft
    const std::vector<kernels::StrainRequest> requests(
        rves.size(), {.f_rel = {1, 0, 0, std::exp(-strain)}, .strain_steps = 1000, .hold_cap = 2000});
    kernels::advance(batch, std::span<const kernels::StrainRequest>(requests), settings, reports);
    kernels::commit(batch);
    for (std::size_t k = 0; k < rves.size(); ++k) {
      const double* s = reports[k].stress;
      if (kernels::is_failure(reports[k].status)) ended[k] = 1;
      if (ended[k] != 0) continue;
      curves[k].push_back({-s[3], -0.5 * (s[1] + s[2])});
      if (-s[3] >= oedometric_end) ended[k] = 1;
    }
  }
  return curves;
}

/// Largest |tau_xy|/sigma_yy of a curve above the floor.
double bias_of(std::span<const OedometricPoint> curve) {
  double bias = 0;
  for (const OedometricPoint& point : curve) {
    if (point.stress_yy >= bias_floor) bias = std::max(bias, std::abs(point.stress_xy) / point.stress_yy);
  }
  return bias;
}

}  // namespace

std::vector<double> biases_of(std::span<const PackedRve> rves) {
  std::vector<double> biases;
  for (const std::vector<OedometricPoint>& curve : oedometric_tests(rves)) biases.push_back(bias_of(curve));
  return biases;
}

}  // namespace voussoir::host
