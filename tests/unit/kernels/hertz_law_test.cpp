// The engine with a law that is not linear and remembers nothing, against closed forms: the door for laws
// (docs/how-to/extend.md, "Adding a contact law") is wide enough for more than the one that is used.
#include "tests/hertz_law.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernels/device/host_backend.hpp"
#include "kernels/device/resident_batch.hpp"
#include "kernels/lanes/group_launch.hpp"
#include "kernels/lanes/wide_lane.hpp"
#include "tests/engine_support.hpp"

namespace voussoir::kernels {
namespace {

using Law = HertzLaw<lanes::WideLane<double>>;
using HostSpace = Kokkos::DefaultHostExecutionSpace;

constexpr double thickness = 0.1;  // [m]
constexpr int copies = 3;          // RVEs: one lane would not show that they are kept apart

RveBatch batch_of(Packing packing) {
  packing.thickness = thickness;
  return make_batch({std::move(packing)}, std::vector<int>(copies, 0), history_size<Law>);
}

std::vector<int> all() { return {0, 1, 2}; }

void put(RveBatch& batch, int grain, double x, double y) {
  for (std::size_t k = 0; k < copies; ++k) {
    batch.committed.position(k, grain, 0) = x;
    batch.committed.position(k, grain, 1) = y;
  }
}

void set_cell(RveBatch& batch, double width, double height) {
  const double cell[4] = {width, 0, 0, height};
  for (std::size_t k = 0; k < copies; ++k) std::copy_n(cell, 4, &batch.committed.cell(k, 0));
}

template <class Drive>
RveReport advanced(RveBatch& batch, const typename Drive::Request& request, const EngineSettings& settings) {
  std::vector<RveReport> reports(copies);
  const std::vector<typename Drive::Request> requests(copies, request);
  lanes::launch<Law, Drive>(batch, std::span<const typename Drive::Request>(requests), settings, reports, all());
  EXPECT_EQ(reports[0].stress[3], reports[2].stress[3]);
  return reports[0];
}

/// A column of grains of two sizes in turn, each on the next, through the periodic cell: all contacts are the same one,
/// and every grain is at rest whatever the overlap [m].
struct Column {
  static constexpr double small = 0.8e-3, large = 1.0e-3, width = 6e-3;  // [m]
  static constexpr int grains = 6;
  static constexpr double sum = small + large;

  static double constant() { return hertz_constant({}, small, {}, large); }

  static RveBatch at(double overlap) {
    Packing packing;
    for (int i = 0; i < grains; ++i) packing.radii.push_back(i % 2 == 0 ? small : large);
    RveBatch batch = batch_of(std::move(packing));
    set_cell(batch, width, grains * (sum - overlap));
    for (int i = 0; i < grains; ++i) put(batch, i, 0.5 * width, (i + 0.3) * (sum - overlap));
    return batch;
  }
};

TEST(HertzLaw, TwoGrainsPushAndStiffenAsTheFormulasSay) {
  for (const double overlap : {1e-7, 1e-6, 1e-5, 1e-4}) {  // [m]
    RveBatch batch = Column::at(overlap);
    const RveReport r = advanced<StrainDrive>(batch, {.hold_cap = 16}, in_double());
    EXPECT_EQ(r.status, RveStatus::converged);
    EXPECT_EQ(r.contacts, Column::grains);
    const double area = Column::width * thickness, length = Column::sum - overlap;
    const double force = Column::constant() * std::pow(overlap, 1.5);
    const double stiffness = 1.5 * Column::constant() * std::sqrt(overlap);
    EXPECT_NEAR(-r.stress[3] * area / force, 1.0, 1e-9) << overlap;
    EXPECT_NEAR(r.tangent[3] * area / (stiffness * length), 1.0, 1e-9) << overlap;  // springs in series, b = length
    EXPECT_EQ(r.stress[0], 0.0);
    EXPECT_NEAR(r.largest_overlap * Column::sum / overlap, 1.0, 1e-9);
    EXPECT_NEAR(r.mean_overlap * Column::sum / overlap, 1.0, 1e-9);
  }
}

TEST(HertzLaw, TwoGrainsAtRestUnderALoadOverlapAsTheFormulaSays) {
  RveBatch batch = Column::at(1e-6);
  const double load = 1e5;  // [Pa]
  ServoRequest request;
  request.x.target = 0;
  request.y.target = -load;
  request.stress_tolerance = 1e-7;
  request.max_steps = 200000;
  EngineSettings settings = in_double();
  settings.hold_tolerance = 1e-6;
  const RveReport r = advanced<ServoDrive>(batch, request, settings);
  EXPECT_EQ(r.status, RveStatus::converged);
  const double width = batch.trial.cell(0, 0), height = batch.trial.cell(0, 3);
  const double overlap = std::pow(load * width * thickness / Column::constant(), 2.0 / 3.0);
  EXPECT_NEAR((Column::sum - height / Column::grains) / overlap, 1.0, 1e-6);
}

/// Equal grains on a hexagonal lattice of constant 2 r - overlap: at rest by symmetry.
struct Hexagons {
  static constexpr double radius = 1e-3;  // [m]
  static constexpr int side = 6;

  static double constant() { return hertz_constant({}, radius, {}, radius); }
  static double force(double overlap) { return constant() * std::pow(overlap, 1.5); }
  static double stiffness(double overlap) { return 1.5 * constant() * std::sqrt(overlap); }
  /// Three contacts a grain of area sqrt(3)/2 a^2.
  static double pressure(double overlap) {
    return std::sqrt(3.0) * force(overlap) / ((2 * radius - overlap) * thickness);
  }
  static double overlap_under(double pressure_wanted) {
    double low = 0, high = 0.1 * radius;
    for (int k = 0; k < 200; ++k) {
      const double middle = 0.5 * (low + high);
      (pressure(middle) < pressure_wanted ? low : high) = middle;
    }
    return low;
  }

  static RveBatch at(double overlap) {
    Packing packing;
    packing.radii.assign(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), radius);
    RveBatch batch = batch_of(std::move(packing));
    const double a = 2 * radius - overlap, row = a * std::sqrt(0.75);
    set_cell(batch, side * a, side * row);
    for (int k = 0; k < side * side; ++k) {
      const int i = k % side, j = k / side;
      put(batch, k, (i + 0.2 + 0.5 * (j % 2)) * a, (j + 0.3) * row);
    }
    return batch;
  }
};

// (D_xxxx + D_xxyy)/2 of the lattice's springs is sqrt(3)/2 k/t. What the engine measures when it is compressed has the
// pressure's own change in it besides: B = sqrt(3)/2 (k + f/a)/t.
TEST(HertzLaw, BulkStiffnessOfAHexagonalPackingGrowsWithTheCubeRootOfPressure) {
  std::vector<double> pressures, by_tangent, by_probe;
  for (const double p : {1e3, 8e3, 64e3}) {
    const double overlap = Hexagons::overlap_under(p), k = Hexagons::stiffness(overlap);
    RveBatch batch = Hexagons::at(overlap);
    EngineSettings settings = in_double();
    settings.tangent = TangentKind::elastic;
    settings.tangent_tolerance = 1e-8;
    const RveReport rest = advanced<StrainDrive>(batch, {.hold_cap = 16}, settings);
    EXPECT_EQ(rest.contacts, 3 * Hexagons::side * Hexagons::side);
    EXPECT_NEAR(rest.pressure() / p, 1.0, 1e-8);
    EXPECT_EQ(rest.tangent_kind, TangentKind::elastic);
    const double bulk = 0.5 * (rest.tangent[0] + rest.tangent[1]);
    EXPECT_NEAR(bulk * thickness / (std::sqrt(0.75) * k), 1.0, 1e-6);

    const double strain = 1e-6, shrunk = 1 - strain;
    const RveReport pressed = advanced<StrainDrive>(
        batch, {.f_rel = {shrunk, 0, 0, shrunk}, .strain_steps = 200, .hold_cap = 2000}, in_double());
    const double probed = (pressed.pressure() - rest.pressure()) / (2 * strain);
    const double a = 2 * Hexagons::radius - overlap;
    EXPECT_NEAR(probed * thickness / (std::sqrt(0.75) * (k + Hexagons::force(overlap) / a)), 1.0, 2e-3);
    pressures.push_back(p);
    by_tangent.push_back(bulk);
    by_probe.push_back(probed);
  }
  for (std::size_t n = 1; n < pressures.size(); ++n) {
    const double decades = std::log(pressures[n] / pressures[n - 1]);
    EXPECT_NEAR(std::log(by_tangent[n] / by_tangent[n - 1]) / decades, 1.0 / 3.0, 2e-3);  // a shrinks by 1 %
    EXPECT_NEAR(std::log(by_probe[n] / by_probe[n - 1]) / decades, 1.0 / 3.0, 5e-3);
  }
}

// The loading tangent is the secant of a small step: it measures what the probe does.
TEST(HertzLaw, LoadingTangentIsTheChangeOfStressByASmallStep) {
  const double overlap = Hexagons::overlap_under(5e4);
  RveBatch batch = Hexagons::at(overlap);
  EngineSettings settings = in_double();
  settings.tangent = TangentKind::loading;
  settings.tangent_strain = -1e-6;  // forward counts where there was no motion: backward is compression
  const RveReport rest = advanced<StrainDrive>(batch, {.hold_cap = 16}, settings);
  ASSERT_EQ(rest.tangent_kind, TangentKind::loading);
  const RveReport pressed = advanced<StrainDrive>(
      batch, {.f_rel = {1 - 1e-6, 0, 0, 1}, .strain_steps = 400, .hold_cap = 20000}, in_double());
  EXPECT_NEAR(rest.tangent[0] / ((rest.stress[0] - pressed.stress[0]) / 1e-6), 1.0, 5e-3);
}

TEST(HertzLaw, BlocksOfADeviceHaveTheAnswersOfLanes) {
  const StrainRequest request{.f_rel = {1.0002, 0.0004, 0, 0.999}, .strain_steps = 100, .hold_cap = 100};
  RveBatch by_lanes = Hexagons::at(2e-5);
  const RveBatch by_blocks = Hexagons::at(2e-5);
  const RveReport a = advanced<StrainDrive>(by_lanes, request, in_double());
  std::vector<RveReport> b(copies);
  const std::vector<StrainRequest> requests(copies, request);
  device::ResidentBatch<HertzLaw<SingleLane<double>>, device::HostBackend> held(device::plain(by_blocks));
  held.advance(std::span<const StrainRequest>(requests), in_double(), b, all());
  EXPECT_FALSE(is_failure(a.status));
  EXPECT_EQ(a.steps, b[0].steps);
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(a.stress[k], b[0].stress[k], 1e-8 * a.pressure()) << k;
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(a.tangent[k], b[0].tangent[k], 1e-8 * a.tangent[0]) << k;
}

TEST(HertzLaw, ABatchOfAnotherLawIsRefused) {
  Packing packing;
  packing.radii = {1e-3, 1e-3};
  RveBatch batch = make_batch({packing}, std::vector<int>(copies, 0));
  EXPECT_THROW(advanced<StrainDrive>(batch, {}, in_double()), std::invalid_argument);
}

}  // namespace
}  // namespace voussoir::kernels
