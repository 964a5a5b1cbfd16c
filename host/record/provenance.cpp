#include "host/record/provenance.hpp"

#include <spdlog/fmt/fmt.h>

#include <Kokkos_Core.hpp>

#include "host/material/devices.hpp"
#include "host/process/build_info.hpp"
#include "host/ranks/session.hpp"
#include "io/utc.hpp"
#include "kernels/isa/choose_lanes.hpp"

namespace voussoir::host {
namespace {

std::string kokkos_description() {
  return fmt::format("Kokkos {}.{}.{}, {}", KOKKOS_VERSION / 10000, KOKKOS_VERSION / 100 % 100, KOKKOS_VERSION % 100,
                     Kokkos::DefaultExecutionSpace::name());
}

std::string lanes_of(const kernels::LaneChoice& choice) {
  return fmt::format("{}; {}", kernels::description_of(choice.lanes->isa), choice.reason);
}

std::string device_of(const Case& input) {
  const DeviceChoice choice = choose_device(input, local_rank());
  return choice.device ? choice.device->name() : "none";
}

}  // namespace

io::Provenance provenance_of(const RunOptions& options, const Case& input, const std::string& kind) {
  io::Provenance p;
  p.case_kind = kind;
  p.input = input.resolved;
  p.fingerprint = input.fingerprint;
  p.version = build_version;
  p.git_hash = build_revision;
  p.build_compiler = build_compiler;
  p.build_type = build_type;
  p.kokkos = kokkos_description();
  p.command = options.command;
  p.date = io::utc_now();
  p.threads = options.threads;
  p.ranks = rank_count();
  p.processor = kernels::processor_name();
  p.lanes = lanes_of(kernels::chosen_lanes());
  p.device = device_of(input);
  return p;
}

}  // namespace voussoir::host
