#pragma once
/// Memory, launches and times on a graphics card.

#include <cuda_runtime.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

namespace voussoir::gpu_step {

inline void check(cudaError_t error) {
  if (error != cudaSuccess) throw std::runtime_error(cudaGetErrorString(error));
}

/// An array on the card.
template <class T>
class DeviceArray {
 public:
  explicit DeviceArray(std::size_t count) : count_(count) {
    check(cudaMalloc(&data_, std::max<std::size_t>(count, 1) * sizeof(T)));
    check(cudaMemset(data_, 0xff, count * sizeof(T)));  // what nobody writes is a NaN
  }
  explicit DeviceArray(const std::vector<T>& from) : DeviceArray(from.size()) { upload(from); }
  DeviceArray(const DeviceArray&) = delete;
  DeviceArray& operator=(const DeviceArray&) = delete;
  ~DeviceArray() { cudaFree(data_); }

  [[nodiscard]] T* data() const { return data_; }
  void upload(const std::vector<T>& from) {
    check(cudaMemcpy(data_, from.data(), count_ * sizeof(T), cudaMemcpyHostToDevice));
  }
  /// `to.size()` elements from element `first` on.
  void download(std::vector<T>& to, std::size_t first = 0) const {
    check(cudaMemcpy(to.data(), data_ + first, to.size() * sizeof(T), cudaMemcpyDeviceToHost));
  }

 private:
  std::size_t count_;
  T* data_ = nullptr;
};

/// The shortest of `repeats` runs of `launch` by events on the card [ms].
template <class Launch>
float shortest_ms(int repeats, const Launch& launch) {
  cudaEvent_t begin = nullptr, end = nullptr;
  check(cudaEventCreate(&begin));
  check(cudaEventCreate(&end));
  float best = 1e30F;
  for (int k = 0; k < repeats; ++k) {
    check(cudaEventRecord(begin));
    launch();
    check(cudaEventRecord(end));
    check(cudaEventSynchronize(end));
    float ms = 0;
    check(cudaEventElapsedTime(&ms, begin, end));
    best = std::min(best, ms);
  }
  check(cudaEventDestroy(begin));
  check(cudaEventDestroy(end));
  return best;
}

/// Registers, stack and blocks of a kernel on this card.
struct KernelUse {
  int registers;
  std::size_t stack;  ///< bytes a thread: spilled registers
  int blocks;         ///< that a multiprocessor holds
};

/// Lets the kernel have its shared memory. No blocks: the card cannot hold it.
template <class Kernel>
KernelUse prepare(Kernel kernel, int threads, std::size_t shared_bytes) {
  cudaFuncAttributes of{};
  check(cudaFuncGetAttributes(&of, kernel));
  KernelUse use{of.numRegs, of.localSizeBytes, 0};
  if (cudaFuncSetAttribute(kernel, cudaFuncAttributeMaxDynamicSharedMemorySize, static_cast<int>(shared_bytes)) !=
      cudaSuccess) {
    cudaGetLastError();
    return use;
  }
  check(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&use.blocks, kernel, threads, shared_bytes));
  return use;
}

}  // namespace voussoir::gpu_step
