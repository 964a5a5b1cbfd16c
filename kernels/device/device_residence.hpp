#pragma once
/// The residence of a batch on a device: it knows which of host and device has the newer committed states, and copies
/// them only when the other one needs them.

#include <memory>

#include "kernels/device/resident_rves.hpp"

namespace voussoir::kernels::device {

/// Moves a batch to a device, which advances it from then on. @throws std::invalid_argument, std::runtime_error as
/// Device::hold
void reside(RveBatch& batch, const std::shared_ptr<Device>& device, Precision precision);

/// What a batch's evaluations moved between host and device so far; zeros where it is on no device.
[[nodiscard]] DeviceWork device_work(const RveBatch& batch);

}  // namespace voussoir::kernels::device
