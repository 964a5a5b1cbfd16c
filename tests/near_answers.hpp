#pragma once
/// Comparison of two engines' answers that differ by rounding.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernels/state/rve_batch.hpp"

namespace voussoir::kernels {

/// By how much answers may differ.
struct Tolerance {
  double stress;       ///< over the pressure; a tangent of eq. (4), over its largest entry, is allowed the same
  double position;     ///< over the mean diameter
  bool counts = true;  ///< steps and contacts are the same
};

/// The largest difference of the stresses, over the pressure.
[[nodiscard]] inline double stress_difference(const RveReport& a, const RveReport& b) {
  double most = 0;
  for (int k = 0; k < 4; ++k) most = std::max(most, std::abs(a.stress[k] - b.stress[k]));
  return most / std::max(std::abs(b.pressure()), 100.0);
}

/// The largest difference of the tangents, over the largest entry.
[[nodiscard]] inline double tangent_difference(const RveReport& a, const RveReport& b) {
  double most = 0, scale = 0;
  for (int k = 0; k < 6; ++k) {
    most = std::max(most, std::abs(a.tangent[k] - b.tangent[k]));
    scale = std::max(scale, std::abs(b.tangent[k]));
  }
  return scale > 0 ? most / scale : most;
}

inline void expect_near_report(const RveReport& a, const RveReport& b, const Tolerance& most, std::size_t rve) {
  EXPECT_EQ(a.status, b.status) << rve << " " << name_of(a.status) << " " << name_of(b.status);
  if (most.counts) {
    EXPECT_EQ(a.steps, b.steps) << rve;
  }
  if (is_failure(b.status) || is_failure(a.status)) return;
  if (most.counts) {
    EXPECT_EQ(a.contacts, b.contacts) << rve;
  }
  EXPECT_LE(stress_difference(a, b), most.stress) << rve;
  if (b.tangent_kind == TangentKind::contact) {
    EXPECT_LE(tangent_difference(a, b), most.stress) << rve;
  }
  EXPECT_EQ(a.tangent_kind, b.tangent_kind) << rve;
  EXPECT_NEAR(a.inertial_number, b.inertial_number, most.stress * b.inertial_number) << rve;
  EXPECT_NEAR(a.largest_overlap, b.largest_overlap, most.stress * b.largest_overlap) << rve;
  EXPECT_NEAR(a.mean_overlap, b.mean_overlap, most.stress * b.mean_overlap) << rve;
  EXPECT_NEAR(a.cell_area, b.cell_area, most.position * b.cell_area) << rve;
  // The ratio is small against the forces that it is the rest of.
  EXPECT_NEAR(a.unbalanced, b.unbalanced, 10 * most.stress) << rve;
}

/// @param force of a contact, which its history is compared with [N]
inline void expect_near_state(const RveStates& a, const RveStates& b, const Packing& packing, const Tolerance& most,
                              double force, std::size_t rve) {
  const double d = packing.mean_diameter();
  for (std::size_t k = 0; k < 4; ++k) ASSERT_NEAR(a.cell(rve, k), b.cell(rve, k), most.position * d) << rve;
  const Mat2 h{b.cell(rve, 0), b.cell(rve, 1), b.cell(rve, 2), b.cell(rve, 3)};
  for (std::size_t i = 0; i < packing.radii.size(); ++i) {
    const double x = a.position(rve, i, 0) - b.position(rve, i, 0), y = a.position(rve, i, 1) - b.position(rve, i, 1);
    const double across = std::round((h.yy * x - h.xy * y) / h.det()), up = std::round((h.xx * y - h.yx * x) / h.det());
    ASSERT_LE(std::hypot(x - h.xx * across - h.xy * up, y - h.yx * across - h.yy * up), most.position * d)
        << rve << " " << i;
    ASSERT_NEAR(a.rotation(rve, i), b.rotation(rve, i), 10 * most.position) << rve << " " << i;
  }
  if (!most.counts) return;
  ASSERT_EQ(a.contact_count(rve), b.contact_count(rve)) << rve;
  for (int c = 0; c < a.contact_count(rve); ++c) {
    ASSERT_EQ(a.contact_key(rve, c), b.contact_key(rve, c)) << rve << " " << c;
    ASSERT_NEAR(a.contact_history(rve, c, 0), b.contact_history(rve, c, 0), 10 * most.stress * force)
        << rve << " " << c;
    ASSERT_NEAR(a.contact_history(rve, c, 1), b.contact_history(rve, c, 1), 10 * most.stress * force * d)
        << rve << " " << c;
  }
}

}  // namespace voussoir::kernels
