// Stiffness ratios kappa = k_n/(p t) from 50 to 1e7, and large increments at 1 kPa: every evaluation ends with a status
// that says what happened.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/packing/recipe.hpp"
#include "tests/engine_support.hpp"

namespace voussoir::kernels {
namespace {

/// A packing at rest with kappa = k_n/(p t) of its mean grain.
host::PackedRve packing_of_stiffness(double kappa, double pressure) {
  host::SoilCase soil;
  const double radius = 0.25 * (soil.size_minimum + soil.size_maximum);
  soil.modulus = kappa * pressure * soil.thickness / radius;
  host::PackingCase recipe;
  recipe.grains = 60;
  recipe.pressure = pressure;
  const std::int64_t seed[] = {1};
  return host::make_packings(soil, recipe, seed).front();
}

/// Steps that keep the inertial number of the increment at 1e-4.
StrainRequest slowly(const Mat2& f, const Packing& packing, double pressure) {
  const double steps = symmetric_norm(log_of(f)) * packing.inertial_time(pressure) / 1e-4;
  return {.f_rel = f, .strain_steps = static_cast<int>(std::clamp(steps, 100.0, 40000.0)), .hold_cap = 2000};
}

// From grains as soft as half their pressure's overlap to such as are rigid to seven digits.
TEST(EngineStiffness, FromFiftyToTenMillionEveryRveRestsAndShears) {
  for (const double kappa : {50.0, 1e3, 1e5, 1e7}) {
    const host::PackedRve rve = packing_of_stiffness(kappa, 1e4);
    ASSERT_EQ(rve.status, RveStatus::converged) << kappa;
    EXPECT_NEAR(rve.pressure, 1e4, 3e-4 * 1e4) << kappa;  // 2e-5 was measured
    for (const Precision precision : {Precision::float32, Precision::float64}) {
      RveBatch batch = host::batch_of(std::span(&rve, 1));
      const Mat2 shear{1.0, 1e-3, 0.0, 1.0};
      RveReport report;
      for (int increment = 0; increment < 3; ++increment) {
        report = run(batch, {slowly(shear, rve.packing, 1e4)}, {.precision = precision}).front();
        ASSERT_TRUE(report.status == RveStatus::converged || report.status == RveStatus::step_limit)
            << kappa << name_of(report.status);
        commit(batch);
      }
      const double shear_stress = 0.5 * (report.stress[1] + report.stress[2]);
      EXPECT_GT(shear_stress, 0.0) << kappa;
      EXPECT_LT(std::hypot(0.5 * (report.stress[0] - report.stress[3]), shear_stress), 0.9 * report.pressure())
          << kappa;
      // delta/d is 1/kappa at the mean force; forces reach some ten times that.
      const double mean_overlap = report.pressure() / 1e4 / kappa;
      EXPECT_GT(report.largest_overlap, mean_overlap) << kappa;
      EXPECT_LT(report.largest_overlap, 30.0 * mean_overlap) << kappa;
      EXPECT_NEAR(report.mean_overlap / mean_overlap, 1.0, 0.5) << kappa;
    }
  }
}

// 1 kPa, kappa = 5e4: an increment of 1e-3 is fifty times the strain that its pressure is worth.
TEST(EngineStiffness, OneKilopascalTakesIncrementsOfOnePerMille) {
  const host::PackedRve rve = packing_of_stiffness(5e4, 1e3);
  ASSERT_EQ(rve.status, RveStatus::converged);
  const Mat2 motions[] = {{1.0, 1e-3, 0, 1},    {0.999, 0, 0, 1.0},   {1.001, 0, 0, 0.999},
                          {1.001, 0, 0, 1.001}, {0.999, 0, 0, 0.999}, {1, -1e-3, 0, 1}};
  for (const Precision precision : {Precision::float32, Precision::float64}) {
    RveBatch batch = host::batch_of(std::span(&rve, 1));
    for (int increment = 0; increment < 18; ++increment) {
      const StrainRequest request = {.f_rel = motions[increment % 6], .strain_steps = 2000, .hold_cap = 2000};
      const RveReport report = run(batch, {request}, {.precision = precision}).front();
      ASSERT_FALSE(is_failure(report.status)) << increment << " " << name_of(report.status);
      ASSERT_TRUE(std::isfinite(report.pressure()));
      ASSERT_LT(report.steps, 4001);
      EXPECT_EQ(report.status == RveStatus::open, report.pressure() == 0.0) << name_of(report.status);
      commit(batch);
    }
    EXPECT_LT(
        run(batch, {{.f_rel = {0.99, 0, 0, 0.99}, .strain_steps = 10000, .hold_cap = 4000}}, {.precision = precision})
            .front()
            .status,
        RveStatus::open)
        << "it carries load again";
  }
}

}  // namespace
}  // namespace voussoir::kernels
