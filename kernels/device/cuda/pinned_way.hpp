#pragma once
/// Copies from the device that run beside its kernels: in a stream of their own, through pinned memory.
///
/// Only pinned memory can be copied to while kernels run, and at the full rate of the bus. The arrays of the host are
/// not pinned, because pinning takes as long as several copies; two small pinned buffers take turns, one filled by the
/// device and the other one emptied by the host.

#include <algorithm>
#include <array>
#include <cstring>

#include "kernels/device/cuda/cuda_errors.hpp"

namespace voussoir::kernels::device {

class PinnedWay {
 public:
  PinnedWay() {
    check_cuda(cudaGetDevice(&device_), "no device is chosen");
    check_cuda(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "there is no stream for copies");
    for (Buffer& buffer : buffers_) {
      check_cuda(cudaMallocHost(&buffer.data, buffer_bytes), "there is no pinned memory");
      check_cuda(cudaEventCreateWithFlags(&buffer.filled, cudaEventDisableTiming), "there is no event for copies");
    }
  }
  PinnedWay(const PinnedWay&) = delete;
  PinnedWay& operator=(const PinnedWay&) = delete;
  ~PinnedWay() {
    for (const Buffer& buffer : buffers_) {
      if (buffer.filled != nullptr) cudaEventDestroy(buffer.filled);
      if (buffer.data != nullptr) cudaFreeHost(buffer.data);
    }
    if (stream_ != nullptr) cudaStreamDestroy(stream_);
  }

  /// @throws std::runtime_error where the device fails
  void copy_down(void* to, const void* from, std::size_t bytes) {
    check_cuda(cudaSetDevice(device_), "the device cannot be chosen");  // the choice belongs to a thread
    char* const target = static_cast<char*>(to);
    const char* const source = static_cast<const char*>(from);
    for (std::size_t first = 0; first < bytes + buffer_bytes; first += buffer_bytes) {
      if (first < bytes) fill(buffer(first), source + first, std::min(buffer_bytes, bytes - first));
      if (first < buffer_bytes) continue;
      const std::size_t before = first - buffer_bytes;
      empty(buffer(before), target + before, std::min(buffer_bytes, bytes - before));
    }
  }

 private:
  static constexpr std::size_t buffer_bytes = std::size_t(8) << 20;
  struct Buffer {
    void* data = nullptr;
    cudaEvent_t filled = nullptr;
  };
  int device_ = 0;
  cudaStream_t stream_ = nullptr;
  std::array<Buffer, 2> buffers_{};

  [[nodiscard]] const Buffer& buffer(std::size_t first) const { return buffers_[first / buffer_bytes % 2]; }
  void fill(const Buffer& to, const char* from, std::size_t bytes) const {
    check_cuda(cudaMemcpyAsync(to.data, from, bytes, cudaMemcpyDeviceToHost, stream_), "a copy from the device failed");
    check_cuda(cudaEventRecord(to.filled, stream_), "a copy from the device failed");
  }
  static void empty(const Buffer& from, char* to, std::size_t bytes) {
    check_cuda(cudaEventSynchronize(from.filled), "a copy from the device failed");
    std::memcpy(to, from.data, bytes);
  }
};

}  // namespace voussoir::kernels::device
