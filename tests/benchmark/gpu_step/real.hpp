#pragma once
/// Arithmetic that a graphics card and a host compute alike, to the last bit, in float and in double.

#include <cmath>
#include <cstdint>

/// Functions that both nvcc and g++ compile. A called function is never inlined.
#if defined(__CUDACC__)
#define VOUSSOIR_DEVICE __host__ __device__ __forceinline__
#define VOUSSOIR_DEVICE_CALL __device__ __noinline__
#else
#define VOUSSOIR_DEVICE inline
#define VOUSSOIR_DEVICE_CALL [[gnu::noinline]] inline
#endif

/// Loops that keep an array in registers. The host's compiler behind nvcc does not know the pragma.
#if defined(__CUDA_ARCH__)
#define VOUSSOIR_UNROLL _Pragma("unroll")
#else
#define VOUSSOIR_UNROLL
#endif

namespace voussoir::gpu_step {

/// Four and two numbers that are loaded and stored by as few instructions as possible.
template <class Real>
struct alignas(4 * sizeof(Real)) Quad {
  Real x, y, z, w;
};
template <class Real>
struct alignas(2 * sizeof(Real)) Two {
  Real x, y;
};

/// Row-major 2x2 matrix in double.
struct Mat2 {
  double xx, xy, yx, yy;
};

/// a b + c, rounded once. All other products and sums are rounded one by one (-fmad=false, -ffp-contract=off).
template <class Real>
VOUSSOIR_DEVICE Real fused(Real a, Real b, Real c) {
  return std::fma(a, b, c);
}

/// 1 / x for normal numbers. On a card it is an estimate that Newton's rule refines; in float and in double it had the
/// host's bits in every comparison so far, which the benchmark checks.
VOUSSOIR_DEVICE float reciprocal(float x) {
#if defined(__CUDA_ARCH__)
  float y;
  asm("rcp.approx.ftz.f32 %0, %1;" : "=f"(y) : "f"(x));
  return fmaf(y, fmaf(-x, y, 1.0F), y);
#else
  return 1.0F / x;
#endif
}
VOUSSOIR_DEVICE double reciprocal(double x) {
#if defined(__CUDA_ARCH__)
  double y;
  asm("rcp.approx.ftz.f64 %0, %1;" : "=d"(y) : "d"(x));
  y = fma(y, fma(-x, y, 1.0), y);
  return fma(y, fma(-x, y, 1.0), y);
#else
  return 1.0 / x;
#endif
}

template <class Real>
VOUSSOIR_DEVICE Real least(Real a, Real b) {
  return std::fmin(a, b);
}
template <class Real>
VOUSSOIR_DEVICE Real most(Real a, Real b) {
  return std::fmax(a, b);
}

/// x, but not beyond -bound and bound.
template <class Real>
VOUSSOIR_DEVICE Real capped(Real x, Real bound) {
  return most(-bound, least(x, bound));
}

/// Divides a block of memory into arrays. With a null pointer, on the host, it only counts the bytes.
class Carver {
 public:
  VOUSSOIR_DEVICE explicit Carver(char* memory) : memory_(memory) {}

  template <class T>
  VOUSSOIR_DEVICE T* take(int count) {
    used_ = (used_ + alignof(T) - 1) / alignof(T) * alignof(T);
#if defined(__CUDA_ARCH__)  // without a choice of pointers nvcc knows that all of them point to shared memory
    T* const array = reinterpret_cast<T*>(memory_ + used_);
#else
    T* const array = memory_ == nullptr ? nullptr : reinterpret_cast<T*>(memory_ + used_);
#endif
    used_ += sizeof(T) * static_cast<std::size_t>(count);
    return array;
  }
  [[nodiscard]] VOUSSOIR_DEVICE std::size_t bytes() const { return used_; }

 private:
  char* memory_;
  std::size_t used_ = 0;
};

}  // namespace voussoir::gpu_step
