#pragma once
/// Puts the static tangents of a group's lanes in place of eq. (4) in their reports, where they were found and are
/// usable.

#include <algorithm>
#include <chrono>

#include "kernels/lanes/group_run.hpp"
#include "kernels/tangents/found_tangent.hpp"

namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES {

/// Lane l of a symmetric tangent. @param v volume of its cell [m^3]
template <class V>
[[nodiscard]] FoundTangent found_in(const StaticTangent<V>& result, TangentKind kind, std::size_t l, double v) {
  FoundTangent found{kind, {}, {}, result.iterations[l], result.converged[l]};
  for (std::size_t k = 0; k < 6; ++k) found.tangent[k] = static_cast<double>(result.tangent[k][l]) / v;
  return found;
}

/// Lane l of a loading tangent, with the change of stress that the change of volume makes. @param stress xx xy yx yy
/// [Pa]
template <class V>
[[nodiscard]] FoundTangent found_in(const LoadingTangent<V>& result, const double* stress, std::size_t l, double v) {
  const double carried[3] = {stress[0], stress[3], 0.5 * (stress[1] + stress[2])};
  double d[3][3];
  for (std::size_t a = 0; a < 3; ++a) {
    const double dilation = a < 2 ? 1.0 : 0.0;
    for (std::size_t b = 0; b < 3; ++b)
      d[b][a] = static_cast<double>(result.change[a][b][l]) / v - dilation * carried[b];
  }
  return {TangentKind::loading,
          {d[0][0], 0.5 * (d[0][1] + d[1][0]), 0.5 * (d[0][2] + d[2][0]), d[1][1], 0.5 * (d[1][2] + d[2][1]), d[2][2]},
          {0.5 * (d[0][1] - d[1][0]), 0.5 * (d[0][2] - d[2][0]), 0.5 * (d[1][2] - d[2][1])},
          result.iterations[l],
          result.converged[l]};
}

/// Writes the static tangents into the reports of the lanes that have an answer. Eq. (4) stays where a static tangent
/// is not usable, and the elastic tangent where no loading tangent is found.
template <class Run>
VOUSSOIR_OWN_SYMBOL void replace_tangents(Run& run, std::array<RveReport, Run::width>& reports) {
  const Region region(run.regions, "tangents");
  const auto since = std::chrono::steady_clock::now();
  const bool loads = run.settings.tangent == TangentKind::loading;
  std::array<bool, Run::width> live{};
  for (std::size_t l = 0; l < Run::width; ++l) live[l] = run.lanes[l].rve >= 0 && !is_failure(reports[l].status);
  const auto at_once = static_tangent(run.group, run.springs, live, run.settings);
  LoadingTangent<typename Run::Value> on_the_way;
  if (loads) {
    run.step.size = step_sizes<typename Run::Value>(run.lanes, run.settings.tangent_strain);
    on_the_way = loading_tangent(run.group, run.springs, run.step, at_once, live, run.settings);
  }
  for (std::size_t l = 0; l < Run::width; ++l) {
    if (!live[l]) continue;
    RveReport& report = reports[l];
    double contact[6];
    std::copy_n(report.tangent, 6, contact);
    const double v = volume_of(run, l);
    const FoundTangent first = found_in(at_once, loads ? TangentKind::elastic : run.settings.tangent, l, v);
    report.tangent_iterations = first.iterations;
    report.tangent_capped = !first.converged;
    replace_tangent(report, first, contact);
    if (!loads) continue;
    const FoundTangent second = found_in(on_the_way, report.stress, l, v);
    report.tangent_iterations += second.iterations;
    report.tangent_capped = !second.converged;
    if (second.converged) replace_tangent(report, second, contact);
  }
  run.tangent_seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
}

}  // namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES
