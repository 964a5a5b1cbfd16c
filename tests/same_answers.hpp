#pragma once
/// Comparison of two engines' answers, bit by bit.

#include <gtest/gtest.h>

#include <cmath>

#include "kernels/state/rve_batch.hpp"

namespace voussoir::kernels {

inline void expect_same_report(const RveReport& a, const RveReport& b, std::size_t rve) {
  EXPECT_EQ(a.status, b.status) << rve << " " << name_of(a.status) << " " << name_of(b.status);
  EXPECT_EQ(a.steps, b.steps) << rve;
  if (is_failure(b.status)) return;
  EXPECT_EQ(a.contacts, b.contacts) << rve;
  for (int k = 0; k < 4; ++k) EXPECT_EQ(a.stress[k], b.stress[k]) << rve << " " << k;
  for (int k = 0; k < 6; ++k) EXPECT_EQ(a.tangent[k], b.tangent[k]) << rve << " " << k;
  EXPECT_EQ(a.unbalanced, b.unbalanced) << rve;
  EXPECT_EQ(a.inertial_number, b.inertial_number) << rve;
  EXPECT_EQ(a.largest_overlap, b.largest_overlap) << rve;
  EXPECT_EQ(a.mean_overlap, b.mean_overlap) << rve;
}

inline void expect_same_state(const RveStates& a, const RveStates& b, std::size_t rve, std::size_t grains) {
  for (std::size_t i = 0; i < grains; ++i) {
    for (std::size_t c = 0; c < 2; ++c) {
      if (std::isnan(a.position(rve, i, c)) && std::isnan(b.position(rve, i, c))) continue;
      ASSERT_EQ(a.position(rve, i, c), b.position(rve, i, c)) << rve << " " << i;
    }
    ASSERT_EQ(a.rotation(rve, i), b.rotation(rve, i)) << rve << " " << i;
  }
  for (std::size_t k = 0; k < 4; ++k) ASSERT_EQ(a.cell(rve, k), b.cell(rve, k)) << rve;
  ASSERT_EQ(a.contact_count(rve), b.contact_count(rve)) << rve;
  for (int c = 0; c < a.contact_count(rve); ++c) {
    ASSERT_EQ(a.contact_key(rve, c), b.contact_key(rve, c)) << rve << " " << c;
    ASSERT_EQ(a.contact_history(rve, c, 0), b.contact_history(rve, c, 0)) << rve << " " << c;
    ASSERT_EQ(a.contact_history(rve, c, 1), b.contact_history(rve, c, 1)) << rve << " " << c;
  }
}

}  // namespace voussoir::kernels
