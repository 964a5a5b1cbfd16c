#pragma once
/// The engine's verbs with one RVE per team of threads: what a GPU runs. The time loop is inside the kernel and every
/// team ends with its RVE. An RVE's answer has the bits of `EngineSettings::backend = lanes` on the same processor,
/// whatever the team's size.
///
/// Called through `kernels::advance` (advance_rves.hpp).

#include <span>

#include "kernels/state/requests.hpp"
#include "kernels/state/rve_batch.hpp"

namespace voussoir::kernels::teams {

/// Given motions of some RVEs (their numbers, each once), on Kokkos' default execution space.
/// @throws std::invalid_argument for a static tangent, a microstructure along the path, a team the space cannot form,
/// or packings whose list does not fit the scratch
Work advance(RveBatch& batch, std::span<const StrainRequest> requests, const EngineSettings& settings,
             std::span<RveReport> reports, std::span<const int> rves);

/// Stress-controlled cells.
Work advance(RveBatch& batch, std::span<const ServoRequest> requests, const EngineSettings& settings,
             std::span<RveReport> reports, std::span<const int> rves);

/// Bytes of scratch one running team takes, in fast memory and besides it.
struct TeamScratchBytes {
  std::size_t hot, cold;
};
[[nodiscard]] TeamScratchBytes team_scratch_bytes(int grains, Precision precision);

}  // namespace voussoir::kernels::teams
