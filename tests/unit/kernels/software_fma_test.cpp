// Fused operations in software against the library's, which has the instruction's bits on every processor.

#include "kernels/contact/software_fma.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "kernels/course/flush_subnormals.hpp"

namespace voussoir::kernels {
namespace {

/// A number of random sign and digits, many of whose last digits are 0 (ties), and of a given exponent.
template <class Real>
Real random_number(std::mt19937_64& engine, int exponent) {
  constexpr int digits = std::numeric_limits<Real>::digits;
  const int zeros = static_cast<int>(engine() % static_cast<unsigned>(digits));
  const auto whole = static_cast<Real>((engine() >> (64 - digits)) >> zeros << zeros);
  return std::ldexp(engine() % 2 == 0 ? whole : -whole, exponent - digits);
}

template <class Real>
void compare(int largest_exponent, int count, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  const auto between = [&](int low, int high) {
    return low + static_cast<int>(engine() % static_cast<unsigned>(high - low + 1));
  };
  int rounded = 0;
  for (int k = 0; k < count; ++k) {
    const int ea = between(-largest_exponent, largest_exponent), eb = between(-largest_exponent, largest_exponent);
    const Real a = random_number<Real>(engine, ea), b = random_number<Real>(engine, eb);
    // The addend lies at all distances from far below the product to far above it.
    const int ec = std::clamp(ea + eb + between(-130, 130), std::numeric_limits<Real>::min_exponent,
                              std::numeric_limits<Real>::max_exponent - 1);
    const Real c = random_number<Real>(engine, ec);
    const Real expected = std::fma(a, b, c);
    const Real got = software_fma(a, b, c);
    ASSERT_EQ(got, expected) << a << " " << b << " " << c;
    rounded += got != a * b + c ? 1 : 0;
  }
  EXPECT_GT(rounded, count / 100);  // two roundings would have been seen
}

TEST(SoftwareFma, HasTheBitsOfTheInstruction) {
  compare<float>(60, 300000, 1);
  compare<double>(400, 300000, 2);
}

TEST(SoftwareFma, HasTheBitsOfTheInstructionWhereSubnormalsAreFlushed) {
  const FlushSubnormals flush;
  compare<float>(70, 300000, 3);  // products down to 1e-42
  compare<double>(505, 300000, 4);
}

/// a*b is a little more or less than the middle between two numbers; the addend decides.
TEST(SoftwareFma, SeesWhatLiesBelowATie) {
  const float a = 1 + 0x1p-12f, b = 1 + 0x1p-12f;  // a*b = 1 + 2^-11 + 2^-24, a tie
  for (const float c : {0x1p-60f, -0x1p-60f, 0x1p-100f, -0x1p-100f})
    EXPECT_EQ(software_fma(a, b, c), std::fma(a, b, c));
  const double x = 1 + 0x1p-27, y = 1 + 0x1p-26;  // x*y = 1 + 2^-26 + 2^-27 + 2^-53, a tie
  for (const double c : {0x1p-300, -0x1p-300, 0x1p-900, -0x1p-900}) EXPECT_EQ(software_fma(x, y, c), std::fma(x, y, c));
}

template <class Real>
void compare_extremes() {
  constexpr Real infinity = std::numeric_limits<Real>::infinity(), largest = std::numeric_limits<Real>::max(),
                 smallest = std::numeric_limits<Real>::min(), tiny = std::numeric_limits<Real>::denorm_min();
  const Real all[] = {0,
                      1,
                      -3,
                      infinity,
                      -infinity,
                      largest,
                      -largest,
                      smallest,
                      tiny,
                      -tiny,
                      smallest * Real(1.5),
                      std::numeric_limits<Real>::quiet_NaN()};
  for (const Real a : all) {
    for (const Real b : all) {
      for (const Real c : all) {
        const Real expected = std::fma(a, b, c), got = software_fma(a, b, c);
        if (std::isnan(expected)) {
          EXPECT_TRUE(std::isnan(got)) << a << " " << b << " " << c;
        } else {
          EXPECT_EQ(got, expected) << a << " " << b << " " << c;
        }
      }
    }
  }
}

TEST(SoftwareFma, HasTheLibrarysExtremes) {
  compare_extremes<float>();
  compare_extremes<double>();
}

}  // namespace
}  // namespace voussoir::kernels
