#pragma once
/// The engine's verbs: all RVEs of a batch, each by its own request, from committed to trial state.
///
/// RVEs are sorted into groups of one packing and similar predicted work; a group costs its slowest lane. Every RVE's
/// answer is bit-identical whatever its group, lane or thread (same build, same precision).

#include <span>

#include "kernels/state/requests.hpp"
#include "kernels/state/rve_batch.hpp"

namespace voussoir::kernels {

/// Whether teams of threads run what any of them can; a static tangent or a recorded microstructure needs lanes
/// (`automatic`).
[[nodiscard]] bool takes_teams(Backend backend);

/// Given motions. `requests` and `reports` have batch.size() entries.
/// Writes batch.trial; never throws for a numerical reason: each RVE's status says how it ended.
Work advance(RveBatch& batch, std::span<const StrainRequest> requests, const EngineSettings& settings,
             std::span<RveReport> reports);

/// The same of some RVEs: `rves` are their numbers, each at most once. The states and reports of the others are left as
/// they are.
Work advance(RveBatch& batch, std::span<const StrainRequest> requests, const EngineSettings& settings,
             std::span<RveReport> reports, std::span<const int> rves);

/// Stress-controlled cells (consolidation, element tests).
Work advance(RveBatch& batch, std::span<const ServoRequest> requests, const EngineSettings& settings,
             std::span<RveReport> reports);

}  // namespace voussoir::kernels
