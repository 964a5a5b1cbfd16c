#pragma once
/// The committed state of a pool's RVEs at one moment. It shares the pool's arrays, which the pool leaves alone as long
/// as somebody holds them, so that neither a relaxation nor a checkpoint needs a copy of millions of grains.

#include <cstdint>
#include <future>
#include <vector>

#include "fem/material_batch.hpp"
#include "host/material/deferral.hpp"
#include "kernels/state/rve_batch.hpp"

namespace voussoir::host {

struct HeldRves final : public fem::HeldState {
  kernels::RveStates states;
  std::vector<kernels::RveReport> reports;
  std::vector<Deferral::Committed> deferred;  ///< empty where no RVE may be deferred
  std::vector<std::size_t> grains;            ///< of each RVE
  std::uint64_t identity = 0;                 ///< RvePool::identity

  std::shared_future<void> arriving;  ///< valid where a device has the states, which then come beside the run

  /// Waits until the states are here. @throws what the device failed with
  void wait() const {
    if (arriving.valid()) arriving.get();
  }
  [[nodiscard]] std::size_t size() const override;
  void write(const Sink& sink) const override;
  /// The record of one RVE (state_records.hpp).
  void write_record(std::size_t rve, std::vector<std::byte>& bytes) const;
};

}  // namespace voussoir::host
