#pragma once
/// The widest value of the instruction set for which a file is compiled. Only the lanes, and tests that are compiled as
/// they are, include this file; all other code asks the chosen LaneSet (isa/choose_lanes.hpp) for the width.

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "kernels/contact/lane.hpp"
#include "kernels/isa/instruction_set.hpp"

#if !defined(VOUSSOIR_LANES)
#error "VOUSSOIR_LANES is to name the set of lanes for which this file is compiled (kernels/CMakeLists.txt)"
#endif

namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES {

#if defined(VOUSSOIR_AVX512)
template <class real>
using WideLane = Kokkos::Experimental::simd<real, abi::avx512_fixed_size<64 / sizeof(real)>>;
inline constexpr InstructionSet own_set = InstructionSet::v4;
#elif defined(KOKKOS_ARCH_AVX2) && !defined(__CUDACC__)
template <class real>
using WideLane = Kokkos::Experimental::simd<real, abi::avx2_fixed_size<32 / sizeof(real)>>;
inline constexpr InstructionSet own_set = InstructionSet::v3;
#else
template <class real>
using WideLane = SingleLane<real>;
inline constexpr InstructionSet own_set = InstructionSet::scalar;
#endif

/// The numbers from[index[l]], lane by lane.
template <class V>
[[nodiscard]] VOUSSOIR_LANES_INLINE V gathered(const real_of<V>* from, const std::int32_t* index) {
  const auto at = [&](int l) { return from[index[l]]; };
#if defined(VOUSSOIR_AVX512)
  if constexpr (std::is_same_v<V, Doubles8>) {
    return V(_mm512_set_pd(at(7), at(6), at(5), at(4), at(3), at(2), at(1), at(0)));
  } else if constexpr (std::is_same_v<V, Floats16>) {
    return V(_mm512_set_ps(at(15), at(14), at(13), at(12), at(11), at(10), at(9), at(8), at(7), at(6), at(5), at(4),
                           at(3), at(2), at(1), at(0)));
  }
#endif
  std::array<real_of<V>, static_cast<std::size_t>(lane_count<V>)> numbers;
  for (int l = 0; l < lane_count<V>; ++l) numbers[static_cast<std::size_t>(l)] = at(l);
  V out;
  out.copy_from(numbers.data(), Kokkos::Experimental::simd_flag_default);
  return out;
}

/// Two numbers, lane by lane. In memory the two of a lane stand side by side, in the order of the lanes, so that one
/// load brings both of any lane.
template <class V>
struct Two {
  V x, y;
};

template <class V>
VOUSSOIR_LANES_INLINE void store_side_by_side(const V& x, const V& y, Two<V>& to) {
#if defined(VOUSSOIR_AVX512)
  if constexpr (std::is_same_v<V, Doubles8>) {
    const auto a = static_cast<__m512d>(x), b = static_cast<__m512d>(y);
    const __m512i low = _mm512_set_epi64(11, 3, 10, 2, 9, 1, 8, 0), high = _mm512_set_epi64(15, 7, 14, 6, 13, 5, 12, 4);
    to = {V(_mm512_permutex2var_pd(a, low, b)), V(_mm512_permutex2var_pd(a, high, b))};
    return;
  } else if constexpr (std::is_same_v<V, Floats16>) {
    const auto a = static_cast<__m512>(x), b = static_cast<__m512>(y);
    const __m512i low = _mm512_set_epi32(23, 7, 22, 6, 21, 5, 20, 4, 19, 3, 18, 2, 17, 1, 16, 0);
    const __m512i high = _mm512_add_epi32(low, _mm512_set1_epi32(8));
    to = {V(_mm512_permutex2var_ps(a, low, b)), V(_mm512_permutex2var_ps(a, high, b))};
    return;
  }
#endif
  auto* const numbers = reinterpret_cast<real_of<V>*>(&to);
  for (int l = 0; l < lane_count<V>; ++l) {
    numbers[2 * l] = x[static_cast<std::size_t>(l)];
    numbers[2 * l + 1] = y[static_cast<std::size_t>(l)];
  }
}

template <class V>
[[nodiscard]] VOUSSOIR_LANES_INLINE Two<V> load_side_by_side(const Two<V>& from) {
#if defined(VOUSSOIR_AVX512)
  if constexpr (std::is_same_v<V, Doubles8>) {
    const auto a = static_cast<__m512d>(from.x), b = static_cast<__m512d>(from.y);
    const __m512i even = _mm512_set_epi64(14, 12, 10, 8, 6, 4, 2, 0), odd = _mm512_set_epi64(15, 13, 11, 9, 7, 5, 3, 1);
    return {V(_mm512_permutex2var_pd(a, even, b)), V(_mm512_permutex2var_pd(a, odd, b))};
  } else if constexpr (std::is_same_v<V, Floats16>) {
    const auto a = static_cast<__m512>(from.x), b = static_cast<__m512>(from.y);
    const __m512i even = _mm512_set_epi32(30, 28, 26, 24, 22, 20, 18, 16, 14, 12, 10, 8, 6, 4, 2, 0);
    const __m512i odd = _mm512_add_epi32(even, _mm512_set1_epi32(1));
    return {V(_mm512_permutex2var_ps(a, even, b)), V(_mm512_permutex2var_ps(a, odd, b))};
  }
#endif
  const auto* const numbers = reinterpret_cast<const real_of<V>*>(&from);
  Two<V> out{V(0), V(0)};
  for (int l = 0; l < lane_count<V>; ++l) {
    out.x[static_cast<std::size_t>(l)] = numbers[2 * l];
    out.y[static_cast<std::size_t>(l)] = numbers[2 * l + 1];
  }
  return out;
}

/// The two numbers of the lanes `index` of all lanes of `from`.
template <class V>
[[nodiscard]] VOUSSOIR_LANES_INLINE Two<V> gathered(const Two<V>* from, const std::int32_t* index) {
  const auto* const numbers = reinterpret_cast<const real_of<V>*>(from);
#if defined(VOUSSOIR_AVX512)
  if constexpr (std::is_same_v<V, Doubles8>) {
    const auto at = [&](int l) { return _mm_loadu_pd(numbers + 2 * static_cast<std::ptrdiff_t>(index[l])); };
    const auto every_other = [&](int l) {
      const __m256d low = _mm256_set_m128d(at(l + 2), at(l)), high = _mm256_set_m128d(at(l + 6), at(l + 4));
      return _mm512_insertf64x4(_mm512_castpd256_pd512(low), high, 1);
    };
    const __m512d even = every_other(0), odd = every_other(1);
    return {V(_mm512_unpacklo_pd(even, odd)), V(_mm512_unpackhi_pd(even, odd))};
  } else if constexpr (std::is_same_v<V, Floats16>) {
    const auto at = [&](int l) {
      double two;
      std::memcpy(&two, numbers + 2 * static_cast<std::ptrdiff_t>(index[l]), sizeof(two));
      return two;
    };
    const auto eight = [&](int l) {
      return V(_mm512_castpd_ps(
          _mm512_set_pd(at(l + 7), at(l + 6), at(l + 5), at(l + 4), at(l + 3), at(l + 2), at(l + 1), at(l))));
    };
    return load_side_by_side(Two<V>{eight(0), eight(8)});
  }
#endif
  Two<V> out{V(0), V(0)};
  for (int l = 0; l < lane_count<V>; ++l) {
    out.x[static_cast<std::size_t>(l)] = numbers[2 * index[l]];
    out.y[static_cast<std::size_t>(l)] = numbers[2 * index[l] + 1];
  }
  return out;
}

}  // namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES
