#pragma once
/// Flushes subnormal numbers to zero while a worker advances RVEs. The velocities of grains at rest decay into
/// subnormal numbers, with which a step on a CPU costs ten times as much. On a GPU, where they cost nothing, this class
/// does nothing.

#include <Kokkos_Macros.hpp>

#if defined(__SSE2__) && !defined(__CUDA_ARCH__) && !defined(__HIP_DEVICE_COMPILE__)
#define VOUSSOIR_FLUSHES_SUBNORMALS
#include <immintrin.h>
#endif

namespace voussoir::kernels {

class FlushSubnormals {
 public:
#if defined(VOUSSOIR_FLUSHES_SUBNORMALS)
  FlushSubnormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | 0x8040U); }
  ~FlushSubnormals() { _mm_setcsr(saved_); }

 private:
  unsigned saved_;
#else
  KOKKOS_FUNCTION FlushSubnormals() {}
  KOKKOS_FUNCTION ~FlushSubnormals() {}
#endif

 public:
  FlushSubnormals(const FlushSubnormals&) = delete;
  FlushSubnormals& operator=(const FlushSubnormals&) = delete;
};

}  // namespace voussoir::kernels
