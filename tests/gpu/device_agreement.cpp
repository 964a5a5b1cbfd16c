// The engine on a device against the lanes of the host, for a machine with a GPU (tools/gpu_check); with the library of
// tests/emulated_gpu it runs anywhere. Prints the largest differences and exits with 1 where one is larger than
// allowed.

#include <Kokkos_Core.hpp>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "kernels/describe_committed.hpp"
#include "kernels/device/device_library.hpp"
#include "kernels/device/device_residence.hpp"
#include "tests/engine_support.hpp"
#include "tests/tiled_packing.hpp"

namespace voussoir::kernels {
namespace {

constexpr std::size_t n_rves = 64;

std::vector<StrainRequest> motions(std::size_t n) {
  std::vector<StrainRequest> requests(n);
  for (std::size_t k = 0; k < n; ++k) {
    const double e = 1e-4 * std::cos(1.0 * static_cast<double>(k));
    requests[k] = {.f_rel = {1 + e, 2 * e, 0, 1 - e}, .strain_steps = 100 + static_cast<int>(k), .hold_cap = 64};
  }
  return requests;
}

const reference::Rve& tile() {
  static const reference::Rve packing = reference::consolidated_packing(60, 2, 1e5, 0.0, reference::Material{});
  return packing;
}

/// What two answers differ by, over the pressure and over the tangent; infinite where statuses or steps differ, or the
/// contacts of an RVE by more than a few.
struct Difference {
  double stress = 0, tangent = 0;
};

double larger_of(double a, double b) { return b <= a ? a : b; }  // keeps a NaN

Difference difference(const std::vector<RveReport>& a, const std::vector<RveReport>& b, int most_contacts) {
  Difference d;
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (a[k].status != b[k].status || a[k].steps != b[k].steps ||
        std::abs(a[k].contacts - b[k].contacts) > most_contacts)
      return {INFINITY, INFINITY};
    for (int c = 0; c < 4; ++c)
      d.stress = larger_of(d.stress, std::abs(a[k].stress[c] - b[k].stress[c]) / b[k].pressure());
    for (int c = 0; c < 6; ++c)
      d.tangent = larger_of(d.tangent, std::abs(a[k].tangent[c] - b[k].tangent[c]) / b[k].tangent[0]);
  }
  return d;
}

/// Two increments, so that states, candidates and histories of the first one are used.
std::vector<RveReport> two_increments(RveBatch& batch, const EngineSettings& settings) {
  run(batch, motions(batch.size()), settings);
  commit(batch);
  return run(batch, motions(batch.size()), settings);
}

/// RVEs of one size: so many copies of a packing side by side in a cell, so that each instance of the engine is seen.
struct Size {
  int columns, rows;
  std::size_t rves;
};

/// @param stress, tangent largest differences that are allowed
bool compare(const std::shared_ptr<device::Device>& on, Precision precision, const Size& size, double stress,
             double tangent) {
  const reference::Rve start = reference::tiled(tile(), size.columns, size.rows);
  const std::size_t n = size.rves;
  const EngineSettings settings{.precision = precision, .hold_tolerance = 1e-12, .tangent = TangentKind::elastic};
  RveBatch lanes = clones(start, n), device = clones(start, n), again = clones(start, n);
  device::reside(device, on, precision);
  device::reside(again, on, precision);
  const auto by_lanes = two_increments(lanes, settings), by_device = two_increments(device, settings);
  const Difference d = difference(by_device, by_lanes, precision == Precision::float64 ? 0 : 4),
                   repeated = difference(two_increments(again, settings), by_device, 0);
  const bool good = d.stress <= stress && d.tangent <= tangent && repeated.stress == 0 && repeated.tangent == 0;
  std::printf(
      "%zu RVEs of %zu grains in %s: stress off by %.1e of the pressure (at most %.0e), tangent by %.1e (at most "
      "%.0e); a "
      "second run by %.0e: %s\n",
      n, start.radii.size(), precision == Precision::float64 ? "double" : "float", d.stress, stress, d.tangent, tangent,
      repeated.stress, good ? "good" : "NOT GOOD");
  return good;
}

/// Whether two numbers are the same, or both none.
bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

bool same(const CommittedSummary& a, const CommittedSummary& b) {
  const Microstructure &x = a.network, &y = b.network;
  bool all = same(a.cell_area, b.cell_area) && same(x.grain_rotation, y.grain_rotation) &&
             same(x.fabric_anisotropy, y.fabric_anisotropy) && same(x.fabric_direction, y.fabric_direction) &&
             same(x.coordination, y.coordination) && same(x.mechanical_coordination, y.mechanical_coordination);
  for (std::size_t k = 0; k < strong_thresholds.size(); ++k)
    all = all && same(x.strong_coordination[k], y.strong_coordination[k]);
  return all;
}

/// What the device says of its committed states, in an increment whose states stay there, has the bits of what the host
/// says when the states have come down.
bool compare_networks(const std::shared_ptr<device::Device>& on) {
  RveBatch batch = clones(tile(), n_rves);
  device::reside(batch, on, Precision::float32);
  std::vector<CommittedSummary> by_device(n_rves), by_host(n_rves);
  const MicrostructureRequest everything{.fabric = true, .coordination = true, .strong_networks = true};
  run(batch, motions(n_rves), {});
  commit(batch);
  describe_committed(batch, everything, by_device);
  const device::DeviceWork work = device::device_work(batch);
  const std::size_t bytes = (work.bytes_up + work.bytes_down) / n_rves;
  bring_committed(batch);
  forget_candidates(batch);  // as if the host had written to the states, so that the host describes them
  describe_committed(batch, everything, by_host);
  std::size_t unlike = 0;
  for (std::size_t k = 0; k < n_rves; ++k) unlike += same(by_device[k], by_host[k]) ? 0U : 1U;
  // 3344 RVEs may move 3 MB.
  const bool good = unlike == 0 && bytes <= 897 && by_device[0].network.mechanical_coordination > 2;
  std::printf("networks: %zu of %zu RVEs differ in a bit; an increment moved %zu bytes an RVE (at most 897): %s\n",
              unlike, n_rves, bytes, good ? "good" : "NOT GOOD");
  return good;
}

bool compare_all(const std::shared_ptr<device::Device>& on) {
  bool good = true;
  for (const Size& size : {Size{1, 1, n_rves}, Size{4, 3, 6}, Size{5, 5, 3}}) {
    good = compare(on, Precision::float64, size, 1e-8, 1e-5) && good;
    good = compare(on, Precision::float32, size, 5e-3, 5e-3) && good;
  }
  return compare_networks(on) && good;
}

}  // namespace
}  // namespace voussoir::kernels

int main(int argc, char** argv) {
  const Kokkos::ScopeGuard kokkos(argc, argv);
  std::string why;
  const auto device = voussoir::kernels::device::open_device(0, why);
  if (!device) {
    std::printf("no device: %s\n", why.c_str());
    return 77;
  }
  std::printf("%s\n", device->name().c_str());
  return voussoir::kernels::compare_all(device) ? 0 : 1;
}
