#pragma once
/// The engine's verbs: all RVEs of a batch, each by its own request, from committed to trial state.
///
/// RVEs are sorted into groups of one packing and similar predicted work; a group costs its slowest lane. Every RVE's
/// answer is bit-identical whatever its group, lane or thread (same build, same precision).

#include <span>

#include "kernels/state/requests.hpp"
#include "kernels/state/rve_batch.hpp"

namespace voussoir::kernels {

/// Whether a backend runs requests by teams of threads. With `automatic`, requests for a static tangent or for recorded
/// microstructures go to lanes nevertheless, since teams cannot answer them.
[[nodiscard]] bool takes_teams(Backend backend);

/// Advances every RVE by a given motion. `requests` and `reports` have batch.size() entries.
/// Writes batch.trial; never throws for a numerical reason: each RVE's status says how it ended.
Work advance(RveBatch& batch, std::span<const StrainRequest> requests, const EngineSettings& settings,
             std::span<RveReport> reports);

/// Advances some RVEs: `rves` are their numbers, each at most once. The states and reports of the others do not change.
Work advance(RveBatch& batch, std::span<const StrainRequest> requests, const EngineSettings& settings,
             std::span<RveReport> reports, std::span<const int> rves);

/// Advances every RVE under controlled stresses (consolidation, element tests).
Work advance(RveBatch& batch, std::span<const ServoRequest> requests, const EngineSettings& settings,
             std::span<RveReport> reports);

}  // namespace voussoir::kernels
