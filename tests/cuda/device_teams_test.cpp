// The whole engine on the device: teams there against lanes on the host, few steps so that rounding stays rounding.

#include <Kokkos_Core.hpp>
#include <cmath>
#include <cstdio>

#include "tests/engine_support.hpp"

namespace {

using namespace voussoir::kernels;

constexpr std::size_t n_rves = 64;

std::vector<RveReport> run_on(Backend backend, Precision precision, const voussoir::reference::Rve& start,
                              RveBatch& batch) {
  batch = clones(start, n_rves);
  std::vector<StrainRequest> requests(n_rves);
  for (std::size_t k = 0; k < n_rves; ++k) {
    const double e = 1e-4 * std::cos(1.0 * static_cast<double>(k));
    requests[k] = {.f_rel = {1 + e, 2 * e, 0, 1 - e}, .strain_steps = 100 + static_cast<int>(k), .hold_cap = 64};
  }
  return run(batch, requests, {.precision = precision, .hold_tolerance = 1e-12, .backend = backend});
}

/// Largest difference of stress over pressure; infinite where statuses, steps or contacts differ.
double difference(const std::vector<RveReport>& a, const std::vector<RveReport>& b) {
  double largest = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (a[k].status != b[k].status || a[k].steps != b[k].steps || a[k].contacts != b[k].contacts) return INFINITY;
    for (int c = 0; c < 4; ++c) {
      const double d = std::abs(a[k].stress[c] - b[k].stress[c]) / b[k].pressure();
      largest = d <= largest ? largest : d;  // keeps a NaN
    }
  }
  return largest;
}

bool compare(const char* what, Precision precision, const voussoir::reference::Rve& start, double tolerance) {
  RveBatch on_device, on_host;
  const auto device = run_on(Backend::teams, precision, start, on_device);
  const auto host = run_on(Backend::lanes, precision, start, on_host);
  const double error = difference(device, host);
  std::printf("%-10s teams against lanes: %.2e of the pressure (at most %.0e)\n", what, error, tolerance);
  return error <= tolerance;
}

}  // namespace

int main(int argc, char** argv) {
  const Kokkos::ScopeGuard kokkos(argc, argv);
  const auto start = voussoir::reference::consolidated_packing(40, 2, 1e5, 0.0, voussoir::reference::Material{});
  // The cell's exponentials come from two libraries: rounding, amplified by some 200 steps.
  const bool in_double = compare("double", Precision::float64, start, 1e-8);
  const bool in_float = compare("float", Precision::float32, start, 5e-3);
  return in_double && in_float ? 0 : 1;
}
