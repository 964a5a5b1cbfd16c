#pragma once
/// What result files tell of all committed states of a batch, and the states themselves do not say at once.

#include <span>

#include "kernels/state/network.hpp"
#include "kernels/state/rve_batch.hpp"

namespace voussoir::kernels {

/// One committed state.
struct CommittedSummary {
  double cell_area = 0;    ///< [m^2]
  Microstructure network;  ///< mean rotation and coordination, and what else was asked for
};

/// Describes every committed state of a batch, with the normal forces that the contact law gives. Where a device has
/// the states, the device describes them, and they stay there. `out` has batch.size() entries.
/// docs/measurements/engine_speed.md, "Microstructure", has the cost.
void describe_committed(const RveBatch& batch, const MicrostructureRequest& wanted, std::span<CommittedSummary> out);

}  // namespace voussoir::kernels
