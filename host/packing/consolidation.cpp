#include "host/packing/consolidation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernels/advance_rves.hpp"

namespace voussoir::host {

namespace {

constexpr int void_ratio_rounds = 8;           ///< rounds of the bisection on the temporary friction
constexpr double void_ratio_tolerance = 0.01;  ///< allowed difference from a wanted void ratio [-]

/// Largest strain per step with which the inertial number is 1e-3 once the pressure has been reached. The lower limit
/// bounds the time that packings of 100 Pa take, the upper one the overlaps of packings of 1 MPa.
double consolidation_rate(const kernels::Packing& packing, double pressure) {
  return std::clamp(1e-3 / packing.inertial_time(pressure), 2e-6, 2e-5);
}

/// Brings all RVEs to rest under the isotropic pressure [Pa]. Each moves at `share` of its own rate, which does not
/// depend on the other RVEs.
std::vector<kernels::RveReport> consolidate(kernels::RveBatch& batch, double pressure, double share) {
  const kernels::ServoAxis axis{.stress_controlled = true, .target = -pressure};
  std::vector<kernels::ServoRequest> requests;
  for (std::size_t k = 0; k < batch.size(); ++k) {
    requests.push_back({.x = axis,
                        .y = axis,
                        .max_rate = share * consolidation_rate(batch.packing(k), pressure),
                        .max_steps = 2000000});
  }
  std::vector<kernels::RveReport> reports(batch.size());
  const kernels::EngineSettings settings{.precision = kernels::Precision::float64, .hold_tolerance = 1e-4};
  kernels::advance(batch, std::span<const kernels::ServoRequest>(requests), settings, reports);
  kernels::commit(batch);
  return reports;
}

/// Takes states and measures from a consolidated batch.
void take_results(std::span<PackedRve> rves, const kernels::RveBatch& batch,
                  std::span<const kernels::RveReport> reports) {
  for (std::size_t k = 0; k < rves.size(); ++k) {
    PackedRve& rve = rves[k];
    load_rve(batch.committed, k, rve);
    rve.void_ratio = void_ratio(rve.cell.det(), rve.packing.solid_area());
    rve.pressure = reports[k].pressure();
    rve.coordination = 2.0 * reports[k].contacts / rve.packing.size();
    rve.unbalanced = reports[k].unbalanced;
    rve.mean_overlap = reports[k].mean_overlap;
    rve.status = reports[k].status;
  }
}

}  // namespace

void rest_at(double pressure, std::span<PackedRve> rves) {
  kernels::RveBatch batch = batch_of(rves);
  const std::vector<kernels::RveReport> reports = consolidate(batch, pressure, 0.1);
  take_results(rves, batch, reports);
}

std::vector<PackedRve> settle(std::span<const PackedRve> loose, double pressure) {
  std::vector<PackedRve> rves(loose.begin(), loose.end());
  kernels::RveBatch batch = batch_of(rves);
  for (std::size_t k = 0; k < rves.size(); ++k) {
    for (kernels::GrainMaterial& material : batch.packings[k].materials) {
      material.friction = rves[k].consolidation_friction;
      if (!rves[k].consolidation_rolling) material.rolling_stiffness = material.rolling_limit = 0;
    }
  }
  consolidate(batch, pressure, 1.0);
  for (std::size_t k = 0; k < rves.size(); ++k) batch.packings[k].materials = rves[k].packing.materials;
  const std::vector<kernels::RveReport> reports = consolidate(batch, pressure, 0.1);
  take_results(rves, batch, reports);
  return rves;
}

std::vector<PackedRve> settle_at_void_ratio(std::vector<PackedRve> loose, double pressure, double void_ratio) {
  std::vector<double> low(loose.size(), 0.0), high(loose.size(), 1.0);
  std::vector<PackedRve> best;
  for (int round = 0; round < void_ratio_rounds; ++round) {
    for (std::size_t k = 0; k < loose.size(); ++k)
      loose[k].consolidation_friction = round == 0 ? 0.25 : 0.5 * (low[k] + high[k]);
    const std::vector<PackedRve> tried = settle(loose, pressure);
    if (best.empty()) best = tried;
    for (std::size_t k = 0; k < loose.size(); ++k) {
      const double miss = tried[k].void_ratio - void_ratio;
      (miss > 0 ? high : low)[k] = loose[k].consolidation_friction;
      if (std::abs(miss) < std::abs(best[k].void_ratio - void_ratio)) best[k] = tried[k];
    }
  }
  for (PackedRve& rve : best) {
    if (std::abs(rve.void_ratio - void_ratio) > void_ratio_tolerance) rve.status = kernels::RveStatus::step_limit;
  }
  return best;
}

}  // namespace voussoir::host
