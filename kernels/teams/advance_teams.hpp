#pragma once
/// The engine of GPUs: one RVE per team of threads. The time loop is inside the kernel, and a team ends when its RVE
/// ends. On the same processor an RVE's answer has the bits of `EngineSettings::backend = lanes`, for every size of
/// teams.
///
/// Call it through `kernels::advance` (advance_rves.hpp).

#include <span>

#include "kernels/state/requests.hpp"
#include "kernels/state/rve_batch.hpp"

namespace voussoir::kernels::teams {

/// Advances some RVEs by given motions, on Kokkos' default execution space: `rves` are their numbers, each at most
/// once.
/// @throws std::invalid_argument for a static tangent, a microstructure along the path, a team size that the space does
/// not allow, or packings whose list does not fit the scratch
Work advance(RveBatch& batch, std::span<const StrainRequest> requests, const EngineSettings& settings,
             std::span<RveReport> reports, std::span<const int> rves);

/// Advances some RVEs under controlled stresses.
Work advance(RveBatch& batch, std::span<const ServoRequest> requests, const EngineSettings& settings,
             std::span<RveReport> reports, std::span<const int> rves);

/// Bytes of scratch that one running team takes: in fast memory (hot), and in the level below it (cold).
struct TeamScratchBytes {
  std::size_t hot, cold;
};
[[nodiscard]] TeamScratchBytes team_scratch_bytes(int grains, Precision precision);

}  // namespace voussoir::kernels::teams
