#pragma once
/// A device with CUDA: its memory, and the launch of one block for each RVE. host_backend.hpp says what a backend has.
///
/// The kernel is a plain __global__ function and not a Kokkos team policy: an RVE of 700 grains wants 79 KiB of fast
/// memory, and Kokkos 4.5 grants a team 41 KiB of the 227 KiB that a block of compute capability 9.0 may have.

#include <algorithm>
#include <array>

#include "kernels/device/block_advance.hpp"
#include "kernels/device/block_copy.hpp"
#include "kernels/device/block_network.hpp"
#include "kernels/device/cuda/pinned_way.hpp"

namespace voussoir::kernels::device {

template <int Threads>
struct CudaBlock {
  [[nodiscard]] __device__ __forceinline__ static int thread() { return static_cast<int>(threadIdx.x); }
  [[nodiscard]] __device__ __forceinline__ static constexpr int threads() { return Threads; }
  [[nodiscard]] __device__ __forceinline__ static char* fast_memory() {
    extern __shared__ char fast[];
    return fast;
  }
  __device__ __forceinline__ static void barrier() { __syncthreads(); }
};

/// An instance of the kernel: so many threads to a block, at least so many blocks at once on a multiprocessor, and so
/// many pairs and grains in the registers of a thread.
template <int Threads, int Blocks, int PairSlots, int GrainSlots>
struct CudaPlan {
  static constexpr int threads = Threads, blocks = Blocks;
  static constexpr int pairs = Threads * PairSlots, grains = Threads * GrainSlots;
  using Plan = BlockPlan<PairSlots, GrainSlots>;
};
using SmallPlan = CudaPlan<128, 4, 6, 3>;   ///< up to 384 grains
using MiddlePlan = CudaPlan<256, 2, 7, 3>;  ///< up to 768
using LargePlan = CudaPlan<512, 1, 7, 3>;   ///< up to 1536
using MemoryPlan = CudaPlan<256, 2, 0, 0>;  ///< any number, in the device's memory

template <class Law, class Drive, class Of, bool classes>
__global__ void __launch_bounds__(Of::threads, Of::blocks)
    advance_kernel(const __grid_constant__ BlockBatch<real_of<typename Law::Value>, Drive> batch,
                   const __grid_constant__ EngineSettings settings, const int pairs, char* const slow,
                   const std::size_t slow_bytes) {
  const int number = static_cast<int>(blockIdx.x);
  // With constant room, the places of all arrays in fast memory are constants of the machine code.
  constexpr bool in_registers = Of::Plan::in_registers;
  using Run = BlockRun<Law, Drive, CudaBlock<Of::threads>, typename Of::Plan, classes>;
  advance_block<Run>({CudaBlock<Of::threads>(), &batch, &settings, slow + static_cast<std::size_t>(number) * slow_bytes,
                      number, in_registers ? Of::grains : batch.packings.stride, in_registers ? Of::pairs : pairs});
}

inline constexpr int copy_threads = 128;     ///< of a block that copies a state
inline constexpr int network_threads = 128;  ///< of a block that describes a contact network

/// A block for each RVE. @tparam Threads is a parameter so that every file may have the kernel
template <int Threads>
__global__ void copy_kernel(const __grid_constant__ DeviceStates from, const __grid_constant__ DeviceStates to) {
  copy_committed_state(CudaBlock<Threads>(), from, to, static_cast<int>(blockIdx.x));
}

/// Likewise.
template <int Threads>
__global__ void __launch_bounds__(Threads) network_kernel(const __grid_constant__ NetworkBatch batch) {
  describe_block(CudaBlock<Threads>(), batch, static_cast<int>(blockIdx.x));
}

struct CudaBackend {
  using WayBeside = PinnedWay;
  static constexpr bool follows_stresses = false;  // few RVEs are made or tested under stresses, and lanes serve them
  static constexpr int levels = 6;  ///< three instances in registers, three with ever more room in memory

  [[nodiscard]] static void* allocate(std::size_t bytes) {
    void* p = nullptr;
    check_cuda(cudaMalloc(&p, bytes), "the device has no memory left");
    return p;
  }
  static void release(void* p) { cudaFree(p); }
  static void copy_up(void* to, const void* from, std::size_t bytes) {
    if (bytes > 0) check_cuda(cudaMemcpy(to, from, bytes, cudaMemcpyHostToDevice), "a copy to the device failed");
  }
  static void copy_down(void* to, const void* from, std::size_t bytes) {
    if (bytes > 0) check_cuda(cudaMemcpy(to, from, bytes, cudaMemcpyDeviceToHost), "a copy from the device failed");
  }

  static void copy_committed(const DeviceStates& from, const DeviceStates& to) {
    copy_kernel<copy_threads><<<static_cast<unsigned>(from.rves), copy_threads>>>(from, to);
    await_kernel();
  }

  /// An instance whose block needs more fast memory than the device grants is left out (Large in double).
  template <class Law, class Drive>
  [[nodiscard]] static int level_from(int level, int grains) {
    if (level <= 0 && grains <= SmallPlan::grains && is_granted<Law, Drive, SmallPlan>()) return 0;
    if (level <= 1 && grains <= MiddlePlan::grains && is_granted<Law, Drive, MiddlePlan>()) return 1;
    if (level <= 2 && grains <= LargePlan::grains && is_granted<Law, Drive, LargePlan>()) return 2;
    return std::max(level, 3);
  }
  template <class Law, class Drive>
  [[nodiscard]] static int room(int level, int grains) {
    constexpr std::array<int, 3> in_registers{SmallPlan::pairs, MiddlePlan::pairs, LargePlan::pairs};
    if (level < 3) return in_registers[static_cast<std::size_t>(level)];
    return std::max(room_in_memory(level - 3, grains), 1024);
  }

  template <class Law, class Drive, bool classes>
  static void launch(const BlockBatch<real_of<typename Law::Value>, Drive>& batch, const EngineSettings& settings,
                     int level, int blocks, int pairs) {
    if (level == 0) return launch_plan<Law, Drive, SmallPlan, classes>(batch, settings, blocks, pairs);
    if (level == 1) return launch_plan<Law, Drive, MiddlePlan, classes>(batch, settings, blocks, pairs);
    if (level == 2) return launch_plan<Law, Drive, LargePlan, classes>(batch, settings, blocks, pairs);
    launch_plan<Law, Drive, MemoryPlan, classes>(batch, settings, blocks, pairs);
  }

  static void describe(const NetworkBatch& batch) {
    const NetworkMemory sizes(no_memory(), network_threads);
    network_kernel<network_threads><<<static_cast<unsigned>(batch.states.rves), network_threads, sizes.bytes>>>(batch);
    await_kernel();
  }

 private:
  template <class Law, class Drive, class Of>
  [[nodiscard]] static bool is_granted() {
    int device = 0, most = 0;
    check_cuda(cudaGetDevice(&device), "no device is chosen");
    check_cuda(cudaDeviceGetAttribute(&most, cudaDevAttrMaxSharedMemoryPerBlockOptin, device),
               "the device does not say what it grants");
    const BlockMemory<Law, Drive, typename Of::Plan> sizes(no_memory(), no_memory(), Of::grains, Of::pairs,
                                                           Of::threads);
    return sizes.fast_bytes <= static_cast<std::size_t>(most);
  }

  /// Waits for the kernel launched last, and not for copies beside it.
  static void await_kernel() {
    check_cuda(cudaGetLastError(), "the kernel was not launched");
    check_cuda(cudaStreamSynchronize(nullptr), "the kernel failed");
  }

  /// How much slow memory there is.
  [[nodiscard]] static std::size_t& slow_bytes() {
    static std::size_t size = 0;
    return size;
  }
  /// The slow memory of all blocks of a launch; it is kept from launch to launch.
  [[nodiscard]] static char* slow_memory(std::size_t bytes) {
    static char* memory = nullptr;
    std::size_t& size = slow_bytes();
    if (bytes > size) {
      if (memory != nullptr) release(memory);
      memory = nullptr;
      size = 0;
      memory = static_cast<char*>(allocate(bytes));
      size = bytes;
    }
    return memory;
  }

  template <class Law, class Drive, class Of, bool classes>
  static void launch_plan(const BlockBatch<real_of<typename Law::Value>, Drive>& batch, const EngineSettings& settings,
                          int blocks, int pairs) {
    const int grains = Of::Plan::in_registers ? Of::grains : batch.packings.stride;
    const BlockMemory<Law, Drive, typename Of::Plan> sizes(no_memory(), no_memory(), grains, pairs, Of::threads);
    const auto kernel = advance_kernel<Law, Drive, Of, classes>;
    check_cuda(
        cudaFuncSetAttribute(kernel, cudaFuncAttributeMaxDynamicSharedMemorySize, static_cast<int>(sizes.fast_bytes)),
        "the device grants a block too little fast memory");
    const std::size_t slow = (sizes.slow_bytes + 255) / 256 * 256;
    // Blocks whose memory would exceed half of what the device has left come one after another.
    std::size_t left = 0, all = 0;
    check_cuda(cudaMemGetInfo(&left, &all), "the device does not say how much memory it has");
    const std::size_t most = std::max(left / 2, slow_bytes());
    const int at_once = static_cast<int>(std::clamp<std::size_t>(most / std::max<std::size_t>(slow, 1), 1, 1U << 30));
    BlockBatch<real_of<typename Law::Value>, Drive> part = batch;
    for (int first = 0; first < blocks; first += at_once) {
      const int count = std::min(at_once, blocks - first);
      char* const memory = slow_memory(slow * static_cast<std::size_t>(count));
      part.order = batch.order + first;
      part.drives = batch.drives + first;
      part.reports = batch.reports + first;
      kernel<<<static_cast<unsigned>(count), Of::threads, sizes.fast_bytes>>>(part, settings, pairs, memory, slow);
      await_kernel();
    }
  }
};

}  // namespace voussoir::kernels::device
