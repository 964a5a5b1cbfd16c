#pragma once
/// Batches held by the engine of GPUs on the host, by blocks of one thread or of several. The instances are compiled
/// once, in device_blocks.cpp, for all tests that include this file.

#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "kernels/device/resident_rves.hpp"
#include "tests/engine_support.hpp"

namespace voussoir::kernels {

/// Blocks of the host's own backend, of threads with everything in memory, and of threads that hold up to 160 pairs and
/// 50 grains each in registers (larger RVEs are in memory).
enum class BlockKind { serial, in_memory, in_registers };

struct Blocks {
  BlockKind kind = BlockKind::serial;
  int threads = 1;      ///< of a block; `serial` has one
  int first_pairs = 0;  ///< of `in_memory`: pairs for which the first level has room; 0: as many as usual
};

/// Holds RVEs. The number of threads and the room are those of the last call of this function.
[[nodiscard]] std::unique_ptr<device::ResidentRves> hold(const device::RveSet& rves, Precision precision,
                                                         const Blocks& blocks);
[[nodiscard]] inline std::unique_ptr<device::ResidentRves> hold(const RveBatch& batch, Precision precision,
                                                                const Blocks& blocks) {
  return hold(device::plain(batch), precision, blocks);
}

/// A device of such blocks.
class BlockDevice final : public device::Device {
 public:
  explicit BlockDevice(const Blocks& blocks) : blocks_(blocks) {}
  [[nodiscard]] std::string name() const override { return "blocks on the host"; }
  [[nodiscard]] std::unique_ptr<device::ResidentRves> hold(const device::RveSet& rves, Precision precision) override {
    return kernels::hold(rves, precision, blocks_);
  }

 private:
  Blocks blocks_;
};

[[nodiscard]] inline std::string name_of(const Blocks& blocks) {
  const char* const kinds[] = {"serial", "in memory", "in registers"};
  return std::string(kinds[static_cast<int>(blocks.kind)]) + ", " + std::to_string(blocks.threads) + " threads";
}

[[nodiscard]] inline std::vector<int> first_rves(std::size_t n) {
  std::vector<int> rves(n);
  std::iota(rves.begin(), rves.end(), 0);
  return rves;
}

/// Advances RVEs of a held batch. The entries of other RVEs in `reports` do not change.
template <class Request>
device::DeviceWork advance_held(device::ResidentRves& held, const std::vector<Request>& requests,
                                const EngineSettings& settings, std::vector<RveReport>& reports,
                                const std::vector<int>& rves) {
  return held.advance(std::span<const Request>(requests), settings, reports, rves);
}
/// Advances all of them.
template <class Request>
std::vector<RveReport> advance_held(device::ResidentRves& held, const std::vector<Request>& requests,
                                    const EngineSettings& settings) {
  std::vector<RveReport> reports(requests.size());
  advance_held(held, requests, settings, reports, first_rves(requests.size()));
  return reports;
}

/// The committed or the trial states of all RVEs, in a batch made from the one that is held.
inline RveStates states_of(device::ResidentRves& held, const RveBatch& batch, bool trial) {
  RveStates states("downloaded", batch.size(), static_cast<int>(batch.committed.rotation.extent(1)),
                   static_cast<int>(batch.committed.history_size()));
  held.download(device::plain(states), first_rves(batch.size()), trial);
  return states;
}

/// The answers of the lanes, whose trial states are in the batch.
inline std::vector<RveReport> run_lanes(RveBatch& batch, const std::vector<StrainRequest>& requests,
                                        const EngineSettings& settings) {
  return run(batch, requests, settings);
}
inline std::vector<RveReport> run_lanes(RveBatch& batch, const std::vector<ServoRequest>& requests,
                                        const EngineSettings& settings) {
  std::vector<RveReport> reports(batch.size());
  advance(batch, std::span<const ServoRequest>(requests), settings, reports);
  return reports;
}

/// Different motions, so that RVEs end at different steps.
inline std::vector<StrainRequest> motions(std::size_t n) {
  std::vector<StrainRequest> requests(n);
  for (std::size_t k = 0; k < n; ++k) {
    const double e = 1e-3 * std::cos(1.0 * static_cast<double>(k));
    requests[k] = {
        .f_rel = {1 + e, 3 * e, -e, 1 - 2 * e}, .strain_steps = 100 + 20 * static_cast<int>(k), .hold_cap = 200};
  }
  return requests;
}

}  // namespace voussoir::kernels
