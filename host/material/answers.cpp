#include "host/material/answers.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "host/packing/law_range.hpp"

namespace voussoir::host {

namespace {

/// Share of unbalanced ratio x pressure that appears as an error of the stress: the moment sum of random residual
/// forces at positions uniform in the cell, 1/sqrt(12). This holds for grains at rest. The unbalanced ratio of an RVE
/// that ended at the step limit does not tell how far its grains still have to move (docs/validation/trade.md); such
/// RVEs are counted instead.
constexpr double noise_share = 0.29;

}  // namespace

fem::Stress stress_of(const kernels::RveReport& r) {
  return {r.stress[0], r.stress[3], 0.5 * (r.stress[1] + r.stress[2])};
}

fem::Tangent tangent_of(const kernels::RveReport& r) {
  const double* d = r.tangent;
  fem::Tangent out;
  out << d[0], d[1], d[2], d[1], d[3], d[4], d[2], d[4], d[5];
  return out;
}

fem::Tangent whole_tangent_of(const kernels::RveReport& r) {
  const double* w = r.tangent_skew;
  fem::Tangent skew;
  skew << 0, w[0], w[1], -w[0], 0, w[2], -w[1], -w[2], 0;
  return tangent_of(r) + skew;
}

void copy_answers(std::span<const kernels::RveReport> reports, std::span<fem::Stress> stress,
                  std::span<fem::Tangent> tangent) {
  for (std::size_t k = 0; k < reports.size(); ++k) {
    stress[k] = stress_of(reports[k]);
    if (!tangent.empty()) tangent[k] = tangent_of(reports[k]);
  }
}

fem::BatchReport summarise(std::span<const kernels::RveReport> reports, const PoolFacts& pool) {
  fem::BatchReport out;
  out.mean_overlap = 0;
  double noise = 0;
  double unsettled = 0;
  std::size_t failures = 0;
  for (std::size_t k = 0; k < reports.size(); ++k) {
    if (pool.retired.contains(k)) continue;
    const kernels::RveReport& r = reports[k];
    if (kernels::is_failure(r.status) && failures++ == 0) {
      out.message = fmt::format("RVE {}: {} (overlap {:.3f})", pool.numbers.empty() ? k : pool.numbers[k],
                                kernels::name_of(r.status), r.largest_overlap);
    }
    if (r.steps > out.slowest_steps) {
      out.slowest = k;
      out.slowest_steps = r.steps;
    }
    if (r.steps == 0) ++out.deferred;
    if (r.status == kernels::RveStatus::open) ++out.open;
    if (r.mean_overlap > most_mean_overlap || r.largest_overlap > most_single_overlap ||
        r.cell_area < pool.least_areas[k])
      ++out.out_of_range;
    out.mean_overlap = std::max(*out.mean_overlap, r.mean_overlap);
    if (r.status == kernels::RveStatus::step_limit) {
      ++out.step_limit;
      unsettled += r.pressure() * r.pressure();
    }
    const double s = noise_share * r.unbalanced * std::max(r.pressure(), pool.pressure_floor);
    noise += s * s;
  }
  if (failures > 1) out.message += fmt::format(" and {} more", failures - 1);
  out.usable = failures == 0;
  const auto counted = static_cast<double>(std::max<std::size_t>(pool.retired.left(), 1));
  out.stress_noise = std::sqrt(noise / counted);
  out.unsettled_stress = std::sqrt(unsettled / counted);
  return out;
}

}  // namespace voussoir::host
