#pragma once
/// A block of a graphics card as a team of threads. threads_team.hpp has the same functions for a host's threads.

namespace voussoir::gpu_step {

template <int team_threads>
struct CudaTeam {
  static constexpr int threads = team_threads;

  __device__ __forceinline__ int rank() const { return static_cast<int>(threadIdx.x); }
  __device__ __forceinline__ int rve() const { return static_cast<int>(blockIdx.x); }
  __device__ __forceinline__ void barrier() const { __syncthreads(); }
  __device__ __forceinline__ char* shared() const {
    extern __shared__ __align__(32) char memory[];
    return memory;
  }

  /// The sum over the 32 threads of a warp by halves: lanes l and l + 16 first, then l and l + 8, and so on.
  template <class T>
  __device__ __forceinline__ T warp_sum(T x) const {
#pragma unroll
    for (int half = 16; half > 0; half >>= 1) x += __shfl_xor_sync(0xffffffffU, x, half);
    return x;
  }

  /// The sum over the threads of a warp with a lower rank.
  __device__ __forceinline__ int warp_sum_before(int x) const {
    int sum = x;
#pragma unroll
    for (int back = 1; back < 32; back <<= 1) {
      const int other = __shfl_up_sync(0xffffffffU, sum, back);
      if (rank() % 32 >= back) sum += other;
    }
    return sum - x;
  }

  /// Adds to a shared counter and returns what the counter was. The order among threads is open.
  __device__ __forceinline__ int add(int& counter, int more) const { return atomicAdd(&counter, more); }
};

}  // namespace voussoir::gpu_step
