// Distances of a touching pair by polynomials against their closed forms, up to the overlap at which an RVE is given
// up.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/contact/engine_law.hpp"
#include "kernels/contact/pair_forces.hpp"
#include "kernels/contact/pair_reference.hpp"

namespace voussoir::kernels {
namespace {

constexpr double r_i = 1e-3, r_j = 3e-3, sum = r_i + r_j;

/// Errors, relative to the closed forms.
struct Errors {
  double overlap, excess, inverse_length;
};

/// Largest errors over overlaps `from` .. `to` of R.
template <class real>
Errors largest_errors(double from, double to) {
  using V = SingleLane<real>;
  const auto shape = pair_shape<EngineLaw<V, true>>(1, {}, r_i, {}, r_j);
  Errors worst{};
  constexpr int n = 2000;
  for (int k = 0; k <= n; ++k) {
    const auto gap = static_cast<real>([&] {
      const double q = from * std::pow(to / from, static_cast<double>(k) / n);
      return sum * sum * q * (q - 2.0);
    }());
    // The overlap that this gap, as rounded, stands for.
    const long double e = -static_cast<long double>(gap) / (static_cast<long double>(sum) * sum);
    const long double q = e / (1 + std::sqrt(1 - e)), length = sum * (1 - q);
    const PairDistance<V> d = distance_of(V(gap), shape);
    const auto error = [](const V& found, long double exact) {
      return static_cast<double>(std::abs(static_cast<long double>(found[0]) / exact - 1));
    };
    worst.overlap = std::max(worst.overlap, error(d.overlap, q));
    worst.excess = std::max(worst.excess, error(d.excess, q / (1 - q)));
    worst.inverse_length = std::max(worst.inverse_length, error(d.inverse_length, 1 / length));
  }
  return worst;
}

/// @param bound on the polynomial's error; rounding comes on top
template <class real>
void expect_within(double to, double bound) {
  const double most = bound + 6.0 * static_cast<double>(std::numeric_limits<real>::epsilon());
  const Errors worst = largest_errors<real>(1e-7, to);
  EXPECT_LE(worst.excess, most) << "up to an overlap of " << to;
  EXPECT_LE(worst.overlap, most) << "up to an overlap of " << to;
  EXPECT_LE(worst.inverse_length, most) << "up to an overlap of " << to;
}

TEST(PairDistance, FollowsTheClosedFormsInFloat) {
  expect_within<float>(0.01, 3e-10);
  expect_within<float>(0.1, 9e-7);
  expect_within<float>(0.2, 5.1e-6);
  expect_within<float>(0.3, 1.2e-5);
}

TEST(PairDistance, FollowsTheClosedFormsInDouble) {
  expect_within<double>(0.01, 5e-15);
  expect_within<double>(0.1, 5.1e-9);
  expect_within<double>(0.2, 2.1e-7);
  expect_within<double>(0.3, 1.4e-6);
}

TEST(PairDistance, ApartThereIsNoOverlap) {
  using V = SingleLane<double>;
  const auto shape = pair_shape<PlainEngineLaw>(1, {}, r_i, {}, r_j);
  for (const double gap : {0.0, 1e-12, sum * sum}) {
    const PairDistance<V> d = distance_of(V(gap), shape);
    EXPECT_EQ(d.overlap[0], 0.0);
    EXPECT_EQ(d.excess[0], 0.0);
    EXPECT_EQ(d.inverse_length[0], 1.0 / sum);
  }
}

}  // namespace
}  // namespace voussoir::kernels
