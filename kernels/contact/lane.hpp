#pragma once
/// The value type of the engine. A value holds one number for each RVE of a group, one RVE per SIMD lane.
///
/// `SingleLane<real>` holds one RVE; it serves RVEs without company (whose pairs are then spread over wide lanes), the
/// threads of a GPU and processors without a wide set of instructions. `WideLane<real>` (lanes/wide_lane.hpp) is as
/// wide as the instruction set allows for which a file of the lanes is compiled. Every kernel is a template over this
/// type and uses the operations of this file only. Lanes are compared with `<` only: Kokkos 4.5.1 swaps the operands of
/// `>` and `>=` of AVX-512 doubles.

#include <Kokkos_Core.hpp>
#include <Kokkos_SIMD.hpp>
#include <type_traits>

#include "kernels/contact/software_fma.hpp"

#if defined(KOKKOS_ARCH_AVX512XEON) && !defined(__CUDACC__)
#define VOUSSOIR_AVX512
#include <immintrin.h>
#endif

/// Marks functions in the loops of lanes: the compiler must inline them even where it finds them too long. They are
/// never compiled for a device.
#define VOUSSOIR_LANES_INLINE inline __attribute__((always_inline))

namespace voussoir::kernels {

namespace abi = Kokkos::Experimental::simd_abi;

template <class real>
using SingleLane = Kokkos::Experimental::simd<real, abi::scalar>;

#if defined(VOUSSOIR_AVX512)
using Floats16 = Kokkos::Experimental::simd<float, abi::avx512_fixed_size<16>>;  // Kokkos' own `native` has only 8
using Doubles8 = Kokkos::Experimental::simd<double, abi::avx512_fixed_size<8>>;
#endif

template <class V>
inline constexpr int lane_count = static_cast<int>(V::size());

template <class V>
using real_of = typename V::value_type;

/// a*b + c in one rounding. Since contraction is off in this project, the compiler fuses no other operations than
/// these.
template <class V>
KOKKOS_FORCEINLINE_FUNCTION V fused(const V& a, const V& b, const V& c) {
  if constexpr (V::size() == 1) {  // Kokkos 4.5's scalar fma rounds twice
    using real = real_of<V>;
#if defined(__x86_64__) && !defined(__FMA__) && !defined(__CUDACC__)
    return V(software_fma(static_cast<real>(a), static_cast<real>(b), static_cast<real>(c)));
#else
    return V(Kokkos::fma(static_cast<real>(a), static_cast<real>(b), static_cast<real>(c)));
#endif
  } else {
    return Kokkos::fma(a, b, c);
  }
}

template <class V>
KOKKOS_FORCEINLINE_FUNCTION V smaller(const V& a, const V& b) {
  if constexpr (V::size() == 1) {
    return Kokkos::Experimental::condition(b < a, b, a);
  } else {
    return Kokkos::min(a, b);
  }
}

template <class V>
KOKKOS_FORCEINLINE_FUNCTION V larger(const V& a, const V& b) {
  if constexpr (V::size() == 1) {
    return Kokkos::Experimental::condition(a < b, b, a);
  } else {
    return Kokkos::max(a, b);
  }
}

/// x limited to [-bound, bound]; bound >= 0. Applying it twice changes nothing, which frozen lanes rely on.
template <class V>
KOKKOS_FORCEINLINE_FUNCTION V clamp_to(const V& x, const V& bound) {
#if defined(VOUSSOIR_AVX512)  // one operation instead of three shortens the chain of every contact
  constexpr int smaller_magnitude_sign_of_first = 0b0010;
  if constexpr (std::is_same_v<V, Floats16>) {
    return V(_mm512_range_ps(static_cast<__m512>(x), static_cast<__m512>(bound), smaller_magnitude_sign_of_first));
  } else if constexpr (std::is_same_v<V, Doubles8>) {
    return V(_mm512_range_pd(static_cast<__m512d>(x), static_cast<__m512d>(bound), smaller_magnitude_sign_of_first));
  }
#endif
  return larger(-bound, smaller(x, bound));
}

/// `a` where x, y and z are all zero, `b` elsewhere.
template <class V>
KOKKOS_FORCEINLINE_FUNCTION V choose_if_zero(const V& x, const V& y, const V& z, const V& a, const V& b) {
#if defined(VOUSSOIR_AVX512)  // two operations instead of five
  constexpr int any_of_three = 0b11111110;
  if constexpr (std::is_same_v<V, Floats16>) {
    const auto bits = [](const V& v) { return _mm512_castps_si512(static_cast<__m512>(v)); };
    const __m512 set = _mm512_castsi512_ps(_mm512_ternarylogic_epi32(bits(x), bits(y), bits(z), any_of_three));
    const __mmask16 zero = _mm512_cmp_ps_mask(set, _mm512_setzero_ps(), _CMP_EQ_OQ);
    return V(_mm512_mask_blend_ps(zero, static_cast<__m512>(b), static_cast<__m512>(a)));
  } else if constexpr (std::is_same_v<V, Doubles8>) {
    const auto bits = [](const V& v) { return _mm512_castpd_si512(static_cast<__m512d>(v)); };
    const __m512d set = _mm512_castsi512_pd(_mm512_ternarylogic_epi64(bits(x), bits(y), bits(z), any_of_three));
    const __mmask8 zero = _mm512_cmp_pd_mask(set, _mm512_setzero_pd(), _CMP_EQ_OQ);
    return V(_mm512_mask_blend_pd(zero, static_cast<__m512d>(b), static_cast<__m512d>(a)));
  }
#endif
  const V zero(0);
  return Kokkos::Experimental::condition((x == zero) && (y == zero) && (z == zero), a, b);
}

/// The lanes of a mask as bits, lane 0 lowest.
template <class Mask>
[[nodiscard]] inline unsigned bits_of(const Mask& mask) {
#if defined(VOUSSOIR_AVX512)
  if constexpr (std::is_same_v<Mask, Doubles8::mask_type>) return static_cast<__mmask8>(mask);
  if constexpr (std::is_same_v<Mask, Floats16::mask_type>) return static_cast<__mmask16>(mask);
#endif
  unsigned bits = 0;
  for (unsigned l = 0; l < Mask::size(); ++l) bits |= (mask[l] ? 1U : 0U) << l;
  return bits;
}

}  // namespace voussoir::kernels
