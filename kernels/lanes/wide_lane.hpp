#pragma once
/// The widest value of the instruction set for which a file is compiled. Only the lanes, and tests that are compiled as
/// they are, include this file; all other code asks the chosen LaneSet (isa/choose_lanes.hpp) for the width.

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

}  // namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES
