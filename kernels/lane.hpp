#pragma once
/// The value type of the engine: one number per RVE of a group, one RVE per SIMD lane.
///
/// `WideLane<real>` is as wide as the build's instruction set allows, `SingleLane<real>` holds one RVE (unlike packings, and
/// the GPU's threads). Every kernel is a template over this type and uses only what stands here.
/// Lanes are compared with `<` only: Kokkos 4.5.1 swaps the operands of `>` and `>=` of AVX-512 doubles.

#include <Kokkos_Core.hpp>
#include <Kokkos_SIMD.hpp>

namespace voussoir::kernels {

namespace abi = Kokkos::Experimental::simd_abi;

template <class real>
using SingleLane = Kokkos::Experimental::simd<real, abi::scalar>;

/// The one place that picks an ABI. Kokkos' own `native` is only 8 wide for float.
template <class real>
struct WideAbi {
  using type = abi::scalar;
};
#if defined(KOKKOS_ARCH_AVX512XEON) && !defined(__CUDACC__)
template <>
struct WideAbi<float> {
  using type = abi::avx512_fixed_size<16>;
};
template <>
struct WideAbi<double> {
  using type = abi::avx512_fixed_size<8>;
};
#elif defined(KOKKOS_ARCH_AVX2) && !defined(__CUDACC__)
template <>
struct WideAbi<float> {
  using type = abi::avx2_fixed_size<8>;
};
template <>
struct WideAbi<double> {
  using type = abi::avx2_fixed_size<4>;
};
#endif

template <class real>
using WideLane = Kokkos::Experimental::simd<real, typename WideAbi<real>::type>;

template <class V>
inline constexpr int lane_count = static_cast<int>(V::size());

template <class V>
using real_of = typename V::value_type;

/// a*b + c in one rounding. Contraction is off in this project, so a fused operation is one that is written.
template <class V>
KOKKOS_FORCEINLINE_FUNCTION V fused(const V& a, const V& b, const V& c) {
  if constexpr (V::size() == 1) {  // Kokkos 4.5's scalar fma rounds twice
    using real = real_of<V>;
    return V(Kokkos::fma(static_cast<real>(a), static_cast<real>(b), static_cast<real>(c)));
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
  return larger(-bound, smaller(x, bound));
}

}  // namespace voussoir::kernels
