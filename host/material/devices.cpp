#include "host/material/devices.hpp"

#include <spdlog/fmt/fmt.h>

#include <cstdlib>
#include <stdexcept>

namespace voussoir::host {

namespace {

/// The number of this process among those of its machine, as launchers tell it.
std::size_t local_rank() {
  for (const char* const name : {"OMPI_COMM_WORLD_LOCAL_RANK", "MPI_LOCALRANKID", "SLURM_LOCALID"}) {
    if (const char* const text = std::getenv(name); text != nullptr) return std::strtoul(text, nullptr, 10);
  }
  return 0;
}

}  // namespace

DevicePointer choose_device(const EngineCase& engine, kernels::TangentKind tangent) {
  if (engine.backend == Backend::lanes || tangent == kernels::TangentKind::loading) return nullptr;
  const kernels::device::DeviceSearch found = kernels::device::find_devices();
  std::string why = found.why_none;
  if (!found.names.empty()) {
    const std::size_t number = local_rank() % found.names.size();
    if (DevicePointer device = kernels::device::open_device(number, why)) return device;
  }
  if (engine.backend == Backend::gpu) throw std::runtime_error("engine.backend is \"gpu\", but no device is there: " + why);
  return nullptr;
}

std::string devices_sentence() {
  const kernels::device::DeviceSearch found = kernels::device::find_devices();
  std::string out = "library: " + (found.library.empty() ? "none" : found.library) + "\n";
  if (found.names.empty()) return out + "devices: none: " + found.why_none + "\n";
  for (std::size_t k = 0; k < found.names.size(); ++k) out += fmt::format("device {}: {}\n", k, found.names[k]);
  return out;
}

}  // namespace voussoir::host
