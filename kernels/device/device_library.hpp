#pragma once
/// The library of a device, which is opened when a program wants a device. A program without the library, or on a
/// machine without the device's driver, runs as if there were no devices.

#include <memory>
#include <string>
#include <vector>

#include "kernels/device/resident_rves.hpp"

namespace voussoir::kernels::device {

/// What a look for devices found.
struct DeviceSearch {
  std::string library;             ///< path of the library that was opened; empty: none
  std::vector<std::string> names;  ///< of its devices, in their order
  std::string why_none;            ///< where there is no device
};

/// Looks for the library and its devices: the file that the environment variable VOUSSOIR_GPU_LIBRARY names, or
/// libvoussoir_gpu.so beside the program (or the Python module), in its folder ../lib, or in ../../cuda, where the
/// preset `cuda` builds it (for the module: ../../../cuda).
[[nodiscard]] DeviceSearch find_devices();

/// The number of devices. Where it is 0, `why` says the reason.
[[nodiscard]] std::size_t count_devices(std::string& why);

/// Opens device `number` (from 0). Null where there is none, and then `why` says the reason.
[[nodiscard]] std::shared_ptr<Device> open_device(std::size_t number, std::string& why);

/// The form of the functions that a library exports under the names below. The number tells a library of another
/// version of the program: it is raised with every change of what crosses the border, and it changes with the sizes of
/// what does.
/// Vectors and texts of the standard library cross too, so that both sides must be compiled with the same one.
inline constexpr std::size_t interface_number = 4 + 1000 * (sizeof(RveReport) + 7 * sizeof(StrainRequest) +
                                                            11 * sizeof(ServoRequest) + 13 * sizeof(EngineSettings) +
                                                            17 * sizeof(Packing) + 19 * sizeof(HostStates) +
                                                            23 * sizeof(DeviceWork) + 29 * sizeof(CommittedSums));
inline constexpr const char* interface_symbol = "voussoir_device_interface";
inline constexpr const char* count_symbol = "voussoir_device_count";
inline constexpr const char* open_symbol = "voussoir_device_open";
using InterfaceFunction = std::size_t (*)();
/// Number of devices; with 0, the text says why.
using CountFunction = std::size_t (*)(std::string* why);
/// Opens a device; null and a text where that fails.
using OpenFunction = Device* (*)(std::size_t number, std::string* why);

}  // namespace voussoir::kernels::device
