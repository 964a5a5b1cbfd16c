#pragma once
/// The device on which the RVEs of a pool reside: the choice that `engine.backend` makes.

#include <functional>
#include <memory>
#include <string>

#include "host/case/case.hpp"
#include "kernels/device/device_library.hpp"

namespace voussoir::host {

using DevicePointer = std::shared_ptr<kernels::device::Device>;

/// The device for a pool, or null where lanes advance its RVEs: because the case says so, because no device was found,
/// or because the tangent is one that a device does not compute. The processes of one machine share its devices in turn.
/// @throws std::runtime_error where the case asks for a device and there is none
[[nodiscard]] DevicePointer choose_device(const EngineCase& engine, kernels::TangentKind tangent);

/// What a search for devices found, for people.
[[nodiscard]] std::string devices_sentence();

}  // namespace voussoir::host
