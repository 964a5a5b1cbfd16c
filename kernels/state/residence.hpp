#pragma once
/// The RVEs of a batch on a device that keeps their states from evaluation to evaluation. A batch without a residence
/// is advanced by the host. kernels/device makes residences; this file is what a batch knows of one.

#include <future>
#include <span>

#include "kernels/state/network_sums.hpp"
#include "kernels/state/requests.hpp"

namespace voussoir::kernels {

struct RveBatch;
struct RveReport;
struct RveStates;

class Residence {
 public:
  Residence() = default;
  Residence(const Residence&) = delete;
  Residence& operator=(const Residence&) = delete;
  virtual ~Residence() = default;

  /// As kernels::advance. @throws std::invalid_argument for what a device does not do
  virtual Work advance(const RveBatch& batch, std::span<const StrainRequest> requests, const EngineSettings& settings,
                       std::span<RveReport> reports, std::span<const int> rves) = 0;
  virtual Work advance(const RveBatch& batch, std::span<const ServoRequest> requests, const EngineSettings& settings,
                       std::span<RveReport> reports, std::span<const int> rves) = 0;
  /// Makes the trial states on the device the committed ones, but for those of the RVEs `kept`.
  virtual void commit(std::span<const int> kept) = 0;
  /// Begins to write the committed states into the arrays `to` of the batch, where the device has newer ones, while
  /// RVEs may be advanced. Until the future is ready, nobody may touch the arrays; its get() throws what the device
  /// failed with. Invalid where the arrays had the newest states already.
  [[nodiscard]] virtual std::shared_future<void> begin_bringing(const RveStates& to) = 0;
  /// Writes the committed state of one RVE into the arrays, where the device has newer ones, and waits for states that
  /// are on their way. The device stays ahead.
  virtual void bring_one(const RveStates& to, int rve) = 0;
  /// Sums over the committed states on the device, where it has them. The states stay there.
  virtual void describe(const MicrostructureRequest& wanted, std::span<CommittedSums> out) = 0;
  /// Whether the committed states are on the device: until the host has written to them.
  [[nodiscard]] virtual bool has_committed() const = 0;
  /// The committed states of the batch were written to by the host, and the device takes them before it runs.
  virtual void forget() = 0;
  /// Whether the committed states on the device are newer than those of the batch.
  [[nodiscard]] virtual bool is_ahead() const = 0;
};

}  // namespace voussoir::kernels
