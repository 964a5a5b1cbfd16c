#pragma once
/// The engine of CPUs: one RVE in each SIMD lane. Call it through `kernels::advance` (advance_rves.hpp).

#include <span>

#include "kernels/state/requests.hpp"
#include "kernels/state/rve_batch.hpp"

namespace voussoir::kernels::lanes {

/// Advances some RVEs by given motions: `rves` are their numbers, each at most once. `requests` and `reports` have
/// batch.size() entries.
Work advance(RveBatch& batch, std::span<const StrainRequest> requests, const EngineSettings& settings,
             std::span<RveReport> reports, std::span<const int> rves);

/// Advances some RVEs under controlled stresses.
Work advance(RveBatch& batch, std::span<const ServoRequest> requests, const EngineSettings& settings,
             std::span<RveReport> reports, std::span<const int> rves);

}  // namespace voussoir::kernels::lanes
