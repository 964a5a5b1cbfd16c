#pragma once
/// The report of one RVE, made from its course and the sums over its contacts at rest.

#include <cmath>

#include "kernels/contact/resting_pair.hpp"
#include "kernels/course/rve_course.hpp"

namespace voussoir::kernels {

/// Mean overlap / (r_i + r_j) of the contacts at the end beyond which an RVE is given up as crushed [-]: 2.5 times the
/// largest one up to which stresses count as those of grains (docs/explanation/range.md).
inline constexpr double mean_overlap_limit = 0.15;

/// The part of a report that any course has, whether it was lost or not.
template <class Drive>
KOKKOS_INLINE_FUNCTION void begin_report(const RveCourse<Drive>& course, RveReport& report) {
  report = RveReport{};
  report.status = course.status;
  report.steps = course.steps;
  report.unbalanced = course.unbalanced;
  report.largest_overlap = course.overlap;
}

/// Sets stress, tangent and status from lane `l` of the sums. @param volume current [m^3]; @param finite whether all
/// grains' motions are finite
template <class V, class Drive>
KOKKOS_INLINE_FUNCTION void fill_report(const RveCourse<Drive>& course, const Homogenised<V>& h, std::size_t l,
                                        double volume, bool finite, const RunScales& scales,
                                        const EngineSettings& settings, RveReport& report) {
  report.stress[0] = h.sums.stress_xx[l] / volume;
  report.stress[1] = h.sums.stress_xy[l] / volume;
  report.stress[2] = h.sums.stress_yx[l] / volume;
  report.stress[3] = h.sums.stress_yy[l] / volume;
  for (int k = 0; k < 6; ++k) report.tangent[k] = static_cast<double>(h.tangent[k][l]) / volume;
  report.contacts = static_cast<int>(h.contacts[l]);
  report.largest_overlap = relative_overlap(static_cast<double>(h.sums.largest_measure[l]));
  report.cell_area = volume / scales.thickness;
  if (report.contacts > 0) report.mean_overlap = static_cast<double>(h.overlaps[l]) / report.contacts;
  const double p = Kokkos::max(report.pressure(), settings.pressure_floor);
  report.inertial_number = course.drive.strain_rate() * inertial_time(scales.mean_mobility, scales.thickness, p);
  double all = volume;
  for (int k = 0; k < 4; ++k) all += report.stress[k];
  for (int k = 0; k < 6; ++k) all += report.tangent[k];
  if (!finite || !std::isfinite(all) || !(volume > 0)) {
    report.status = RveStatus::not_finite;
  } else if (!(report.largest_overlap <= settings.overlap_limit)) {
    report.status = RveStatus::overlap_limit;
  } else if (report.contacts == 0) {
    report.status = RveStatus::open;
  }
}

/// Gives up an RVE whose contacts overlap by too much on average. More contacts than a state has room for are told when
/// they are stored. @param room for contacts in a state
KOKKOS_INLINE_FUNCTION void give_up_crushed(RveReport& report, int room) {
  if (!is_failure(report.status) && report.contacts <= room && report.mean_overlap > mean_overlap_limit)
    report.status = RveStatus::overlap_limit;
}

}  // namespace voussoir::kernels
