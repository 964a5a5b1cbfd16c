#pragma once
/// The RVEs of a batch on a device that keeps their states from evaluation to evaluation. A batch without a residence
/// is advanced by the host. kernels/device makes residences; this file is what a batch knows of one.

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
  /// Writes the committed states into the arrays of the batch, where the device has newer ones.
  virtual void bring(const RveStates& to) = 0;
  /// The same for one RVE. The device stays ahead.
  virtual void bring_one(const RveStates& to, int rve) = 0;
  /// Sums over the committed states that the device has, which must be ahead. The states stay there.
  virtual void describe(const MicrostructureRequest& wanted, std::span<CommittedSums> out) = 0;
  /// The committed states of the batch were written to by the host, and the device takes them before it runs.
  virtual void forget() = 0;
  /// Whether the committed states on the device are newer than those of the batch.
  [[nodiscard]] virtual bool is_ahead() const = 0;
};

}  // namespace voussoir::kernels
