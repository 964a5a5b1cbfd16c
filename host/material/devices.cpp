#include "host/material/devices.hpp"

#include <spdlog/fmt/fmt.h>

#include <stdexcept>

#include "host/case/engine.hpp"

namespace voussoir::host {

DeviceChoice choose_device(const EngineCase& engine, kernels::TangentKind tangent, int local_rank) {
  if (engine.backend == Backend::lanes) return {};
  std::string why;
  DeviceChoice choice;
  if (const std::size_t count = kernels::device::count_devices(why); count > 0) {
    const std::size_t number = static_cast<std::size_t>(local_rank) % count;
    if (tangent == kernels::TangentKind::loading) {
      why = "a device does not compute loading tangents";
    } else {
      choice.device = kernels::device::open_device(number, why);
    }
    if (!choice.device) choice.why_lanes = fmt::format("device {} is not used: {}", number, why);
  }
  if (engine.backend == Backend::gpu && !choice.device)
    throw std::runtime_error("a device is asked for, but none can be used: " + why);
  return choice;
}

DeviceChoice choose_device(const Case& input, int local_rank) {
  if (!uses_engine(input.kind, input.material)) return {};
  return choose_device(input.engine, tangent_kind(input.newton.tangent), local_rank);
}

std::string sentence_of(const DeviceChoice& choice) {
  if (choice.device) return "grains on the device " + choice.device->name();
  return choice.why_lanes.empty() ? std::string() : "grains by lanes: " + choice.why_lanes;
}

std::string devices_sentence() {
  const kernels::device::DeviceSearch found = kernels::device::find_devices();
  std::string out = "library: " + (found.library.empty() ? "none" : found.library) + "\n";
  if (found.names.empty()) return out + "devices: none: " + found.why_none + "\n";
  for (std::size_t k = 0; k < found.names.size(); ++k) out += fmt::format("device {}: {}\n", k, found.names[k]);
  return out;
}

}  // namespace voussoir::host
