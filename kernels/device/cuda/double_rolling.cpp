// The engine for CUDA in double precision, with rolling resistance.

#include "kernels/device/cuda/cuda_instance.hpp"

namespace voussoir::kernels::device {

template std::unique_ptr<ResidentRves> hold_on_cuda<EngineLaw<SingleLane<double>, true>>(const RveSet&);

}  // namespace voussoir::kernels::device
