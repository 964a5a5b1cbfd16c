// Rates of the engine on a device: RVEs x precision for given packings, whole calls and steps alone, beside the lanes
// of the host. Usage: device_rates [--rves N] PACKING.h5... (packings of this program; a number of RVEs instead of
// many).

#include <Kokkos_Core.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <span>
#include <vector>

#include "host/case/case.hpp"
#include "host/packing/packings.hpp"
#include "kernels/advance_rves.hpp"
#include "kernels/device/device_library.hpp"
#include "kernels/device/device_residence.hpp"

namespace voussoir {
namespace {

kernels::RveBatch clones(const host::PackedRve& rve, std::size_t n) {
  kernels::RveBatch batch = kernels::make_batch({rve.packing}, std::vector<int>(n, 0));
  for (std::size_t k = 0; k < n; ++k) host::store_rve(rve, batch, k);
  return batch;
}

struct Time {
  double seconds;
  std::size_t particle_steps;
  int failed;
};

/// The best of three calls of `steps` steps, with a look every 16 during a hold of as many.
Time time_of(kernels::RveBatch& batch, int steps, kernels::Precision precision, kernels::TangentKind tangent) {
  std::vector<kernels::StrainRequest> requests(batch.size());
  for (std::size_t k = 0; k < batch.size(); ++k) {
    const double e = 2.5e-6 * steps * std::cos(0.1 * static_cast<double>(k));
    requests[k] = {.f_rel = {1 + e, e, 0, 1 - e}, .strain_steps = steps, .hold_cap = 1};
  }
  std::vector<kernels::RveReport> reports(batch.size());
  const kernels::EngineSettings settings{
      .precision = precision, .hold_tolerance = 1e-12, .tangent = tangent, .tangent_tolerance = 0.1};
  Time out{1e30, 0, 0};
  for (int turn = 0; turn < 3; ++turn) {
    const auto since = std::chrono::steady_clock::now();
    out.particle_steps = kernels::advance(batch, std::span<const kernels::StrainRequest>(requests), settings, reports)
                             .particle_steps;
    out.seconds = std::min(out.seconds,
                           std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count());
  }
  for (const kernels::RveReport& r : reports) out.failed += kernels::is_failure(r.status) ? 1 : 0;
  return out;
}

int faults = 0;  ///< RVEs that failed, and calls that did

void print_rates(const char* what, kernels::RveBatch& batch, kernels::Precision precision) {
  const Time few = time_of(batch, 10, precision, kernels::TangentKind::contact);
  const Time many = time_of(batch, 410, precision, kernels::TangentKind::contact);
  const Time mesh = time_of(batch, 50, precision, kernels::TangentKind::elastic);
  const double steps = static_cast<double>(many.particle_steps - few.particle_steps) / (many.seconds - few.seconds);
  std::printf("%5d %6zu %-6s %-7s %9.3f %9.3f %9.3f  %8.3f %8.3f %8.3f  %d\n", batch.packings[0].size(), batch.size(),
              precision == kernels::Precision::float32 ? "float" : "double", what, 1e3 * few.seconds,
              1e3 * many.seconds, 1e3 * mesh.seconds, 1e-9 * steps,
              1e-9 * static_cast<double>(many.particle_steps) / many.seconds,
              1e-9 * static_cast<double>(mesh.particle_steps) / mesh.seconds, few.failed + many.failed + mesh.failed);
  std::fflush(stdout);
  faults += few.failed + many.failed + mesh.failed;
}

void measure(const std::shared_ptr<kernels::device::Device>& device, const host::PackedRve& rve, std::size_t n) {
  for (const auto precision : {kernels::Precision::float32, kernels::Precision::float64}) {
    kernels::RveBatch batch = clones(rve, n);
    try {
      kernels::device::reside(batch, device, precision);
      print_rates("device", batch, precision);
      const kernels::device::DeviceWork work = kernels::device::device_work(batch);
      std::printf("      %.0f bytes up and %.0f down for an RVE and call; %zu RVEs ran again with more room\n",
                  static_cast<double>(work.bytes_up) / static_cast<double>(9 * n),
                  static_cast<double>(work.bytes_down) / static_cast<double>(9 * n), work.enlarged);
    } catch (const std::exception& error) {
      std::printf("%5d %6zu: %s\n", rve.packing.size(), n, error.what());
      ++faults;
    }
  }
}

/// @param files packings
void measure_all(const std::shared_ptr<kernels::device::Device>& device, std::span<const std::size_t> numbers,
                 std::span<char* const> files) {
  std::printf("%s\n%5s %6s %-6s %-7s %9s %9s %9s  %8s %8s %8s  %s\n", device->name().c_str(), "N", "RVEs", "real", "on",
              "10: ms", "410: ms", "mesh: ms", "steps G", "410: G", "mesh: G", "failed");
  for (const char* file : files) {
    host::PackingCase recipe;
    recipe.files = {file};
    const host::PackedRve rve = host::choose_packing(host::SoilCase{}, recipe);
    for (const std::size_t n : numbers) measure(device, rve, n);
    kernels::RveBatch lanes = clones(rve, 64);
    print_rates("lanes", lanes, kernels::Precision::float32);
  }
  if (faults > 0) std::printf("%d calls or RVEs failed\n", faults);
}

}  // namespace
}  // namespace voussoir

int main(int argc, char** argv) {
  const Kokkos::ScopeGuard kokkos(argc, argv);
  std::string why;
  const auto device = voussoir::kernels::device::open_device(0, why);
  if (!device) {
    std::printf("no device: %s\n", why.c_str());
    return 77;
  }
  const bool one_number = argc > 2 && std::strcmp(argv[1], "--rves") == 0;
  const std::vector<std::size_t> numbers = one_number ? std::vector<std::size_t>{std::strtoul(argv[2], nullptr, 10)}
                                                      : std::vector<std::size_t>{1, 64, 512, 3344, 8192};
  const std::span<char* const> arguments(argv, static_cast<std::size_t>(argc));
  voussoir::measure_all(device, numbers, arguments.subspan(one_number ? 3 : 1));
  return voussoir::faults > 0 ? 1 : 0;
}
