#pragma once
/// Kokkos 4.5.1 on CUDA 13, force-included (-include) into Kokkos and into code that uses it.
///
/// CUDA 13 replaced the signatures of three calls that Kokkos 4.5.1 makes in their CUDA 12 form. These overloads
/// forward the old form to the new one. They can go once Kokkos 4.7 or newer is required, which calls the new form
/// itself.

#if defined(__CUDACC__)
#include <cuda_runtime.h>

#if CUDART_VERSION >= 13000

/// The old form names a device by its number, or the host by cudaCpuDeviceId.
inline cudaMemLocation voussoir_cuda_location(int device) {
  cudaMemLocation location{};
  location.type = device == cudaCpuDeviceId ? cudaMemLocationTypeHost : cudaMemLocationTypeDevice;
  location.id = device == cudaCpuDeviceId ? 0 : device;
  return location;
}

inline cudaError_t cudaMemAdvise(const void* pointer, size_t bytes, cudaMemoryAdvise advice, int device) {
  return cudaMemAdvise(pointer, bytes, advice, voussoir_cuda_location(device));
}

inline cudaError_t cudaMemPrefetchAsync(const void* pointer, size_t bytes, int device, cudaStream_t stream = nullptr) {
  return cudaMemPrefetchAsync(pointer, bytes, voussoir_cuda_location(device), 0, stream);
}

inline cudaError_t cudaGraphAddDependencies(cudaGraph_t graph, const cudaGraphNode_t* from, const cudaGraphNode_t* to,
                                            size_t count) {
  return cudaGraphAddDependencies(graph, from, to, nullptr, count);
}

#endif
#endif
