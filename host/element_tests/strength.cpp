#include "host/element_tests/strength.hpp"

#include <algorithm>
#include <cmath>

#include "host/packing/law_range.hpp"

namespace voussoir::host {

namespace {

/// Points within half a window of `center`.
std::span<const BiaxialPoint> around(const BiaxialCurve& curve, double center, double window) {
  const auto before = [](const BiaxialPoint& point, double strain) { return point.axial_strain < strain; };
  const auto first = std::lower_bound(curve.points.begin(), curve.points.end(), center - 0.5 * window, before);
  const auto last = std::lower_bound(first, curve.points.end(), center + 0.5 * window, before);
  return {first, last};
}

double mean_ratio(std::span<const BiaxialPoint> points) {
  double sum = 0;
  for (const BiaxialPoint& point : points) sum += point.q() / point.p();
  return sum / static_cast<double>(points.size());
}

/// Least-squares slope of eps_v against eps_q.
double volume_slope(std::span<const BiaxialPoint> points) {
  const auto n = static_cast<double>(points.size());
  double x = 0, y = 0, xx = 0, xy = 0;
  for (const BiaxialPoint& point : points) {
    x += point.shear_strain();
    y += point.volumetric_strain();
    xx += point.shear_strain() * point.shear_strain();
    xy += point.shear_strain() * point.volumetric_strain();
  }
  const double variance = xx - x * x / n;
  return variance > 0 ? (xy - x * y / n) / variance : 0.0;
}

}  // namespace

Strength strength_of(const BiaxialCurve& curve, double window) {
  Strength out;
  if (curve.points.size() < 2) return out;
  const double end = curve.points.back().axial_strain;
  double peak = 0, dilation = 0, lateral = 0, squared = 0;
  for (const BiaxialPoint& point : curve.points) {
    const double off = point.stress_xx / curve.pressure - 1.0;
    lateral += off;
    squared += off * off;
    out.contraction = std::max(out.contraction, point.volumetric_strain());
    const auto near = around(curve, point.axial_strain, window);
    const bool whole = point.axial_strain > 0.5 * window && point.axial_strain < end - 0.5 * window;
    if (near.size() < 3 || !whole) continue;
    if (const double ratio = mean_ratio(near); ratio > peak) {
      peak = ratio;
      out.peak_strain = point.axial_strain;
    }
    dilation = std::max(dilation, -volume_slope(near));
  }
  out.peak_angle = std::asin(std::min(peak, 1.0));
  out.dilatancy = std::asin(std::min(dilation, 1.0));
  const auto last_quarter = around(curve, 0.875 * end, 0.25 * end);
  if (!last_quarter.empty()) out.critical_angle = std::asin(std::min(mean_ratio(last_quarter), 1.0));
  const auto third_quarter = around(curve, 0.625 * end, 0.25 * end);
  if (!last_quarter.empty() && !third_quarter.empty())
    out.late_rise = mean_ratio(last_quarter) / mean_ratio(third_quarter) - 1.0;
  out.lateral_error = std::abs(lateral / static_cast<double>(curve.points.size()));
  out.lateral_scatter = std::sqrt(squared / static_cast<double>(curve.points.size()));
  return out;
}

double mean_stress_at(double pressure, double angle) { return pressure / (1.0 - std::sin(angle)); }

bool held(const BiaxialCurve& curve, const Strength& strength) {
  return curve.status == kernels::RveStatus::converged && strength.lateral_scatter <= most_lateral_scatter &&
         strength.late_rise <= most_late_rise && curve.mean_overlap <= most_mean_overlap;
}

double common_angle(std::span<const double> angles, std::span<const double> p) {
  double pq = 0, pp = 0;
  for (std::size_t k = 0; k < angles.size(); ++k) {
    pq += p[k] * p[k] * std::sin(angles[k]);
    pp += p[k] * p[k];
  }
  return pp > 0 ? std::asin(std::min(pq / pp, 1.0)) : 0.0;
}

CommonDilatancy common_dilatancy(std::span<const double> angles) {
  const auto n = static_cast<double>(angles.size());
  double sines = 0, sum = 0, squares = 0;
  for (const double angle : angles) sines += std::sin(angle), sum += angle;
  for (const double angle : angles) squares += (angle - sum / n) * (angle - sum / n);
  return {.mean = std::asin(sines / n), .deviation = angles.size() > 1 ? std::sqrt(squares / (n - 1)) : 0.0};
}

}  // namespace voussoir::host
