#pragma once
/// The device on which the RVEs of a pool reside: the choice that `engine.backend` makes.

#include <memory>
#include <string>

#include "host/case/case.hpp"
#include "kernels/device/device_library.hpp"

namespace voussoir::host {

using DevicePointer = std::shared_ptr<kernels::device::Device>;

struct DeviceChoice {
  DevicePointer device;   ///< null where lanes advance the RVEs
  std::string why_lanes;  ///< where lanes advance them although a device is there that the case would take
};

/// The device for a pool. Lanes advance its RVEs where the case says so, where no device was found, and with
/// `engine.backend` = "auto" also where the device cannot be opened or does not compute the tangent.
/// @param local_rank number of this process among those of its machine, which share its devices in turn
/// @throws std::runtime_error where the case asks for a device and there is none
[[nodiscard]] DeviceChoice choose_device(const EngineCase& engine, kernels::TangentKind tangent, int local_rank);

/// The same for a case; none where the case runs no RVEs of a mesh.
[[nodiscard]] DeviceChoice choose_device(const Case& input, int local_rank);

/// A sentence about the choice for people; empty where there is no device to speak of.
[[nodiscard]] std::string sentence_of(const DeviceChoice& choice);

/// What a search for devices found, for people.
[[nodiscard]] std::string devices_sentence();

}  // namespace voussoir::host
