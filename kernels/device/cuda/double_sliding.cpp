// The engine for CUDA in double precision, without rolling resistance.

#include "kernels/device/cuda/cuda_instance.hpp"

namespace voussoir::kernels::device {

template std::unique_ptr<ResidentRves> hold_on_cuda<EngineLaw<SingleLane<double>, false>>(const RveSet&);

}  // namespace voussoir::kernels::device
