#pragma once
/// The engine's verbs with one RVE a SIMD lane: what a CPU runs. Called through `kernels::advance` (advance_rves.hpp).

#include <span>

#include "kernels/state/requests.hpp"
#include "kernels/state/rve_batch.hpp"

namespace voussoir::kernels::lanes {

/// Given motions of some RVEs (their numbers, each once). `requests` and `reports` have batch.size() entries.
Work advance(RveBatch& batch, std::span<const StrainRequest> requests, const EngineSettings& settings,
             std::span<RveReport> reports, std::span<const int> rves);

/// Stress-controlled cells.
Work advance(RveBatch& batch, std::span<const ServoRequest> requests, const EngineSettings& settings,
             std::span<RveReport> reports, std::span<const int> rves);

}  // namespace voussoir::kernels::lanes
