#pragma once
/// The engine of a device as its callers see it: RVEs whose states stay on the device from evaluation to evaluation.
///
/// This interface crosses the border of a library that is opened at run time (device_library.hpp), so it has plain
/// pointers, spans and structures of numbers alone, and no Kokkos view.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "kernels/state/network_sums.hpp"
#include "kernels/state/rve_batch.hpp"

namespace voussoir::kernels::device {

/// States in the memory of the host, array by array as in RveStates.
struct HostStates {
  double *position, *rotation, *cell;
  int* contact_count;
  std::uint32_t* contact_key;
  double* contact_history;
  int grains, contacts, history;  ///< extents for each RVE
};
[[nodiscard]] HostStates plain(const RveStates& states);
/// Of the arrays of one RVE.
[[nodiscard]] std::size_t bytes_of_rve(const HostStates& states);

/// The RVEs of a batch, without its views.
struct RveSet {
  const std::vector<Packing>& packings;
  const std::vector<int>& packing_of;  ///< by RVE
  HostStates committed;
};
[[nodiscard]] RveSet plain(const RveBatch& batch);

/// What moved between host and device, and what the device did.
struct DeviceWork {
  std::size_t particle_steps = 0;
  std::size_t bytes_up = 0, bytes_down = 0;
  std::size_t enlarged = 0;  ///< RVEs that ran again, in a block with more room

  DeviceWork& operator+=(const DeviceWork& other) {
    particle_steps += other.particle_steps;
    bytes_up += other.bytes_up;
    bytes_down += other.bytes_down;
    enlarged += other.enlarged;
    return *this;
  }
};

class ResidentRves {
 public:
  ResidentRves() = default;
  ResidentRves(const ResidentRves&) = delete;
  ResidentRves& operator=(const ResidentRves&) = delete;
  virtual ~ResidentRves() = default;

  /// Replaces all committed states.
  virtual void upload(const HostStates& from) = 0;
  /// Copies the committed states within the device. Afterwards bring_copy() takes them to the host.
  virtual void copy_committed() = 0;
  /// Writes what was copied last to `to`. This function alone may run beside the other ones, in a thread of its own; it
  /// must have ended before the next copy. Returns the bytes that it moved.
  virtual std::size_t bring_copy(const HostStates& to) = 0;
  /// Copies the committed states of the RVEs `rves`, or their trial states, to the same places of `to`. The trial state
  /// of an RVE that failed or was not evaluated since the last commit is its committed one.
  virtual void download(const HostStates& to, std::span<const int> rves, bool trial) = 0;
  /// As kernels::advance. `reports` has an entry for each RVE; those of `rves` are written.
  virtual DeviceWork advance(std::span<const StrainRequest> requests, const EngineSettings& settings,
                             std::span<RveReport> reports, std::span<const int> rves) = 0;
  virtual DeviceWork advance(std::span<const ServoRequest> requests, const EngineSettings& settings,
                             std::span<RveReport> reports, std::span<const int> rves) = 0;
  /// Makes the trial states the committed ones, but for those of the RVEs `kept`. Returns what crossed the bus.
  virtual DeviceWork commit(std::span<const int> kept) = 0;
  /// Sums over the committed states of all RVEs, as far as `wanted` needs them.
  virtual DeviceWork describe(const MicrostructureRequest& wanted, std::span<CommittedSums> out) = 0;
};

/// A device, and what it is called.
class Device {
 public:
  Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  virtual ~Device() = default;

  [[nodiscard]] virtual std::string name() const = 0;
  /// Holds RVEs. @throws std::invalid_argument where the device cannot; std::runtime_error where it has no memory for
  /// them
  [[nodiscard]] virtual std::unique_ptr<ResidentRves> hold(const RveSet& rves, Precision precision) = 0;
};

}  // namespace voussoir::kernels::device
