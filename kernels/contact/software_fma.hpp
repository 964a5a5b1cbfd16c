#pragma once
/// a*b + c in one rounding, for processors that have no instruction for it.
///
/// The results are those of the instruction, with and without flushed subnormals
/// (tests/unit/kernels/software_fma_test). The library's `std::fma` has the same results, but on a processor without
/// the instruction it takes 9 (float) and 17 (double) times as long as these functions (glibc 2.36).

#include <bit>
#include <cmath>
#include <cstdint>

namespace voussoir::kernels {

/// A sum rounded to the nearest number, and what the rounding has left.
struct ExactSum {
  double sum, rest;
};

/// Knuth's sum without a condition on the sizes.
[[nodiscard]] inline ExactSum exact_sum(double a, double b) {
  const double sum = a + b, of_b = sum - a;
  return {sum, (a - (sum - of_b)) + (b - of_b)};
}

/// The sum rounded to odd: where it is not exact, the neighbour whose last bit is set. A second rounding to at least
/// two bits less is then as if it were the only one.
[[nodiscard]] inline double sum_to_odd(double a, double b) {
  const ExactSum exact = exact_sum(a, b);
  const auto bits = std::bit_cast<std::int64_t>(exact.sum);
  if ((exact.rest < 0 || exact.rest > 0) && (bits & 1) == 0) {  // false where the rest is not a number
    return std::bit_cast<double>(bits + ((exact.rest > 0) == (exact.sum > 0) ? 1 : -1));
  }
  return exact.sum;
}

/// The product of two floats is exact in double.
[[nodiscard]] inline float software_fma(float a, float b, float c) {
  return static_cast<float>(sum_to_odd(static_cast<double>(a) * static_cast<double>(b), static_cast<double>(c)));
}

/// Whether no part of the algorithm below can overflow or lose bits below the smallest normal number.
[[nodiscard]] inline bool is_moderate(double x) {
  const double size = std::abs(x);
  return size > 0x1p-960 && size < 0x1p960;
}

/// Boldo and Melquiond, "Emulation of a FMA and correctly rounded sums: proved algorithms using rounding to odd", IEEE
/// Transactions on Computers 57 (2008), with Dekker's product. Extreme numbers are left to the library.
[[nodiscard]] inline double software_fma(double a, double b, double c) {
  const double product = a * b;
  if (a == 0 || b == 0) return product + c;
  const double size = std::abs(product);
  if (!is_moderate(a) || !is_moderate(b) || !(size > 0x1p-900 && size < 0x1p900) || !(c == 0 || is_moderate(c))) {
    return std::fma(a, b, c);
  }
  constexpr double splitter = 0x1p27 + 1;
  const double scaled_a = splitter * a, scaled_b = splitter * b;
  const double high_a = scaled_a - (scaled_a - a), high_b = scaled_b - (scaled_b - b);
  const double low_a = a - high_a, low_b = b - high_b;
  const double rest = ((high_a * high_b - product) + high_a * low_b + low_a * high_b) + low_a * low_b;
  const ExactSum low = exact_sum(c, rest), high = exact_sum(product, low.sum);
  return high.sum + sum_to_odd(low.rest, high.rest);
}

}  // namespace voussoir::kernels
