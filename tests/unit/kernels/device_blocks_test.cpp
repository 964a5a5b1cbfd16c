// The blocks of a device, on the host, against the lanes, which are tested against the oracle: within rounding of their
// answers, however many threads a block has and however its memory is divided.

#include <gtest/gtest.h>

#include "kernels/device/host_backend.hpp"
#include "kernels/device/resident_batch.hpp"
#include "tests/engine_support.hpp"

namespace voussoir::kernels {
namespace {

class DeviceBlocks : public testing::Test {
 protected:
  static void SetUpTestSuite() { dense = reference::consolidated_packing(40, 2, 1e5, 0.0, reference::Material{}); }
  static inline reference::Rve dense;
};

std::vector<StrainRequest> motions(std::size_t n) {
  std::vector<StrainRequest> requests(n);
  for (std::size_t k = 0; k < n; ++k) {
    const double e = 1e-3 * std::cos(1.0 * static_cast<double>(k));
    requests[k] = {
        .f_rel = {1 + e, 3 * e, -e, 1 - 2 * e}, .strain_steps = 100 + 20 * static_cast<int>(k), .hold_cap = 200};
  }
  return requests;
}

TEST_F(DeviceBlocks, Try) {
  for (const Precision precision : {Precision::float32, Precision::float64}) {
    RveBatch lanes = clones(dense, 6), blocks = clones(dense, 6);
    EngineSettings settings{.precision = precision, .tangent = TangentKind::elastic};
    settings.tangent_tolerance = 1e-3;
    settings.backend = Backend::lanes;
    const auto expected = run(lanes, motions(6), settings);
    auto held = device::hold<device::HostBackend>(device::plain(blocks), precision);
    std::vector<RveReport> got(6);
    std::vector<int> all{0, 1, 2, 3, 4, 5};
    const auto requests = motions(6);
    held->advance(std::span<const StrainRequest>(requests), settings, got, all);
    for (int k = 0; k < 6; ++k) {
      std::printf("%d: status %d %d steps %d %d contacts %d %d stress %.12e %.12e tangent %.9e %.9e it %d %d kinds %d %d u %.6e %.6e\n", k, (int)expected[k].status, (int)got[k].status,
        expected[k].steps, got[k].steps, expected[k].contacts, got[k].contacts, expected[k].stress[0], got[k].stress[0], expected[k].tangent[0], got[k].tangent[0],
        expected[k].tangent_iterations, got[k].tangent_iterations, (int)expected[k].tangent_kind, (int)got[k].tangent_kind, expected[k].unbalanced, got[k].unbalanced);
    }
  }
}

}  // namespace
}  // namespace voussoir::kernels
