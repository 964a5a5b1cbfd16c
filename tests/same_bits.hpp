#pragma once
/// Comparison of numbers by their bits: a NaN is the same as itself, and 0 is not the same as -0.

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>

namespace voussoir {

inline bool same_bits(std::span<const double> a, std::span<const double> b) {
  const auto bits = [](double number) { return std::bit_cast<std::uint64_t>(number); };
  return std::ranges::equal(a, b, {}, bits, bits);
}

}  // namespace voussoir
