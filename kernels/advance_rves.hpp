#pragma once
/// The functions by which the engine advances RVEs: each RVE of a batch goes, by its own request, from its committed to
/// its trial state.
///
/// A batch that resides on a device (`RveBatch::residence`) is advanced there, and every other one by the lanes.
///
/// RVEs are sorted into groups of one packing and similar predicted work, because a group takes as long as its slowest
/// lane. With one build and one precision, the answer of an RVE has the same bits in every group, lane and thread.

#include <span>

#include "kernels/state/requests.hpp"
#include "kernels/state/rve_batch.hpp"

namespace voussoir::kernels {

/// Advances every RVE by a given motion. `requests` and `reports` have batch.size() entries.
/// The trial states are written where the batch resides, in batch.trial or on its device. The call never throws for a
/// numerical reason: the status of each RVE says how its evaluation ended.
Work advance(RveBatch& batch, std::span<const StrainRequest> requests, const EngineSettings& settings,
             std::span<RveReport> reports);

/// Advances some RVEs: `rves` are their numbers, each at most once. The states and reports of the others do not change.
Work advance(RveBatch& batch, std::span<const StrainRequest> requests, const EngineSettings& settings,
             std::span<RveReport> reports, std::span<const int> rves);

/// Advances every RVE under controlled stresses (consolidation, element tests).
Work advance(RveBatch& batch, std::span<const ServoRequest> requests, const EngineSettings& settings,
             std::span<RveReport> reports);

}  // namespace voussoir::kernels
