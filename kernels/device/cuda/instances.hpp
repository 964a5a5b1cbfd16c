#pragma once
/// The instances of the engine for CUDA. Each of them is a file of its own, because each takes minutes to compile.

#include "kernels/course/choose_instance.hpp"
#include "kernels/device/resident_rves.hpp"

namespace voussoir::kernels::device {

/// Holds RVEs on the present CUDA device.
template <class Law>
[[nodiscard]] std::unique_ptr<ResidentRves> hold_on_cuda(const RveSet& rves);

extern template std::unique_ptr<ResidentRves> hold_on_cuda<EngineLaw<SingleLane<float>, true>>(const RveSet&);
extern template std::unique_ptr<ResidentRves> hold_on_cuda<EngineLaw<SingleLane<float>, false>>(const RveSet&);
extern template std::unique_ptr<ResidentRves> hold_on_cuda<EngineLaw<SingleLane<double>, true>>(const RveSet&);
extern template std::unique_ptr<ResidentRves> hold_on_cuda<EngineLaw<SingleLane<double>, false>>(const RveSet&);

}  // namespace voussoir::kernels::device
