#include "host/kinds/geostatic_check.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fem/gauss_points.hpp"

namespace voussoir::host {
namespace {

constexpr int bands = 20;         ///< number of rows, which have equal heights
constexpr double deep = 100.0e3;  ///< vertical stress from which deflection_deep counts [Pa]

/// A Gauss point away from the opening. Compression is positive.
struct Point {
  double depth;       // [m]
  double volume;      // per metre [m2]
  double vertical;    // [Pa]
  double expected;    // unit weight * depth + surcharge [Pa]
  double k0;          // [-]
  double deflection;  // [rad], without sign
};

std::vector<Point> points_at_rest(const Ground& ground, const GroundCase& soil) {
  const auto n = static_cast<std::size_t>(ground.mesh.n_points());
  std::vector<fem::Stress> stress(n);
  ground.material.committed(stress, {});
  const fem::GaussPoints gauss = fem::gauss_points(ground.mesh, ground.mesh.coordinates);
  const fem::Point axis(0.0, soil.axis_height());
  std::vector<Point> points;
  for (std::size_t p = 0; p < n; ++p) {
    const fem::Point x = gauss.positions.col(static_cast<Eigen::Index>(p));
    if ((x - axis).norm() <= soil.diameter) continue;  // within D/2 of the opening's edge
    const double depth = soil.height - x.y();
    points.push_back({depth, gauss.volumes[p], -stress[p][1], soil.unit_weight * depth + soil.surcharge,
                      stress[p][0] / stress[p][1], std::abs(fem::major_axis_from_vertical(stress[p]))});
  }
  return points;
}

std::vector<GeostaticRow> rows_of(const std::vector<Point>& points, const GroundCase& soil) {
  std::vector<GeostaticRow> rows;
  for (int band = 0; band < bands; ++band) {
    const double top = soil.height * band / bands;
    const double bottom = soil.height * (band + 1) / bands;
    GeostaticRow row;
    double volume = 0;
    double squares = 0;
    for (const Point& p : points) {
      if (p.depth < top || p.depth >= bottom) continue;
      const double error = p.vertical - p.expected;
      volume += p.volume;
      row.error += p.volume * error;
      squares += p.volume * error * error;
      row.k0 += p.volume * p.k0;
      row.deflection += p.volume * p.deflection;
    }
    if (!(volume > 0)) continue;
    row.error /= volume;
    row.k0 /= volume;
    row.deflection /= volume;
    row.scatter = std::sqrt(std::max(0.0, squares / volume - row.error * row.error));
    row.depth = 0.5 * (top + bottom);
    row.vertical = soil.unit_weight * row.depth + soil.surcharge + row.error;
    rows.push_back(row);
  }
  return rows;
}

}  // namespace

GeostaticCheck check_geostatic(const Ground& ground, const GroundCase& soil) {
  const std::vector<Point> points = points_at_rest(ground, soil);
  GeostaticCheck check;
  for (const Point& p : points) {
    const double error = std::abs(p.vertical - p.expected);
    check.vertical_error = std::max(check.vertical_error, error);
    check.vertical_ratio = std::max(check.vertical_ratio, error / (0.05 * p.expected + 1.0e3));
    check.k0_minimum = std::min(check.k0_minimum, p.k0);
    check.k0_maximum = std::max(check.k0_maximum, p.k0);
    check.deflection_max = std::max(check.deflection_max, p.deflection);
    if (p.vertical >= deep) check.deflection_deep = std::max(check.deflection_deep, p.deflection);
    check.deflection_mean += p.deflection / static_cast<double>(points.size());
  }
  check.rows = rows_of(points, soil);
  for (const GeostaticRow& row : check.rows) {
    const double expected = row.vertical - row.error;
    check.row_ratio = std::max(check.row_ratio, std::abs(row.error) / (0.02 * expected + 0.5e3));
    check.row_scatter = std::max(check.row_scatter, row.scatter / row.vertical);
  }
  return check;
}

std::string describe(const GeostaticCheck& check) {
  constexpr double degree = std::numbers::pi / 180.0;
  return fmt::format(
      "the means of the vertical stress over rows of points are within {:.2f} of the allowed 2 % + 0.5 kPa of the "
      "stress at rest, a row scatters by up to {:.2g} %, and single points are off by at most {:.3g} Pa ({:.2f} times "
      "5 % + 1 kPa); K0 is {:.3f} to {:.3f}; the principal axis is off the vertical by {:.2g} deg (mean), {:.2g} deg "
      "(largest), {:.2g} deg (largest from 100 kPa on)",
      check.row_ratio, 100 * check.row_scatter, check.vertical_error, check.vertical_ratio, check.k0_minimum,
      check.k0_maximum, check.deflection_mean / degree, check.deflection_max / degree, check.deflection_deep / degree);
}

}  // namespace voussoir::host
