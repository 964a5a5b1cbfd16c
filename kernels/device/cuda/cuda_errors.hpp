#pragma once
/// Errors of the CUDA runtime as exceptions.

#include <cuda_runtime.h>

#include <stdexcept>
#include <string>

namespace voussoir::kernels::device {

/// @throws std::runtime_error with the words of the runtime
inline void check_cuda(cudaError_t error, const char* what) {
  if (error == cudaSuccess) return;
  cudaGetLastError();  // the runtime would tell it to the next launch again
  throw std::runtime_error(std::string(what) + ": " + cudaGetErrorString(error));
}

}  // namespace voussoir::kernels::device
