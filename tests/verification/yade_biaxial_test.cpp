// The drained biaxial test of Yade's packing, step for step another integrator, against Yade's own curve
// (tests/data/yade).

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

#include "host/element_tests/strength.hpp"
#include "host/packing/recipe.hpp"

namespace voussoir::host {
namespace {

const std::filesystem::path data = std::filesystem::path(VOUSSOIR_SOURCE_DIR) / "tests/data/yade";

struct Row {
  double strain, ratio, volume;
};

/// Columns 2, 9 and 10 of the reference: axial log strain, q/p, volumetric strain.
std::vector<Row> reference_curve() {
  std::ifstream file(data / "CPS_D_biaxial_100kPa.csv");
  std::vector<Row> rows;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    std::vector<double> v;
    for (double x = 0; words >> x;) v.push_back(x);
    rows.push_back({v.at(1), v.at(8), v.at(9)});
  }
  return rows;
}

Row at(const BiaxialCurve& curve, double strain) {
  std::size_t k = 1;
  while (k + 1 < curve.points.size() && curve.points[k].axial_strain < strain) ++k;
  const BiaxialPoint &a = curve.points[k - 1], &b = curve.points[k];
  const double s = (strain - a.axial_strain) / (b.axial_strain - a.axial_strain);
  const auto between = [s](double x, double y) { return x + s * (y - x); };
  return {strain, between(a.q() / a.p(), b.q() / b.p()), between(a.volumetric_strain(), b.volumetric_strain())};
}

TEST(YadeBiaxial, CurveUpToThePeakAndPeakAngle) {
  SoilCase soil;  // the defaults are the reference's: E 3 GPa, k_t/k_n 0.5, 25 deg, beta 1, eta 0.6
  PackingCase recipe;
  recipe.files = {data / "CPS_D_particles.csv"};
  recipe.pressure = 1.0e5;
  const PackedRve rve = settle_foreign_packings(soil, recipe).front();
  ASSERT_EQ(rve.status, kernels::RveStatus::converged);
  EXPECT_NEAR(rve.void_ratio, 0.17549275, 1e-7);
  const kernels::EngineSettings settings{.precision = kernels::Precision::float64};
  const BiaxialCurve curve = biaxial_tests(std::span(&rve, 1), 0.045, 1e-4, 2000, settings).front();
  ASSERT_EQ(curve.status, kernels::RveStatus::converged);

  const std::vector<Row> reference = reference_curve();
  ASSERT_EQ(reference.size(), 393U);
  const auto peak = std::max_element(reference.begin(), reference.end(),
                                     [](const Row& a, const Row& b) { return a.ratio < b.ratio; });
  for (auto row = reference.begin() + 1; row <= peak; ++row) {
    const Row ours = at(curve, row->strain);
    EXPECT_NEAR(ours.ratio, row->ratio, std::max(0.02 * row->ratio, 0.01)) << row->strain;
    EXPECT_NEAR(ours.volume, row->volume, 3e-4) << row->strain;
  }
  double largest = 0;
  for (const BiaxialPoint& point : curve.points) largest = std::max(largest, point.q() / point.p());
  EXPECT_NEAR(std::asin(largest), std::asin(peak->ratio), 1.0 * std::numbers::pi / 180.0);
  EXPECT_LT(strength_of(curve, 0.002).lateral_error, 0.005);
}

}  // namespace
}  // namespace voussoir::host
