#pragma once
/// Included by the files of the instances alone.

#include "kernels/device/cuda/cuda_backend.hpp"
#include "kernels/device/cuda/instances.hpp"
#include "kernels/device/resident_batch.hpp"

namespace voussoir::kernels::device {

template <class Law>
std::unique_ptr<ResidentRves> hold_on_cuda(const RveSet& rves) {
  return std::make_unique<ResidentBatch<Law, CudaBackend>>(rves);
}

}  // namespace voussoir::kernels::device
