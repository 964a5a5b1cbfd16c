#include "kernels/teams/advance_teams.hpp"

#include "kernels/teams/team_launch.hpp"

namespace voussoir::kernels {

namespace {

using Space = Kokkos::DefaultExecutionSpace;

template <class Drive, class real>
Work choose(RveBatch& batch, std::span<const typename Drive::Request> requests, const EngineSettings& settings,
            std::span<RveReport> reports, std::span<const int> rves) {
  using V = SingleLane<real>;
  return rolls(batch)
             ? launch_teams<LinearContactLaw<V, true>, Drive, Space>(batch, requests, settings, reports, rves)
             : launch_teams<LinearContactLaw<V, false>, Drive, Space>(batch, requests, settings, reports, rves);
}

template <class Drive>
Work advance_with(RveBatch& batch, std::span<const typename Drive::Request> requests, const EngineSettings& settings,
                  std::span<RveReport> reports, std::span<const int> rves) {
  return settings.precision == Precision::float32 ? choose<Drive, float>(batch, requests, settings, reports, rves)
                                                  : choose<Drive, double>(batch, requests, settings, reports, rves);
}

}  // namespace

Work advance_teams(RveBatch& batch, std::span<const StrainRequest> requests, const EngineSettings& settings,
                   std::span<RveReport> reports, std::span<const int> rves) {
  return advance_with<StrainDrive>(batch, requests, settings, reports, rves);
}

Work advance_teams(RveBatch& batch, std::span<const ServoRequest> requests, const EngineSettings& settings,
                   std::span<RveReport> reports, std::span<const int> rves) {
  return advance_with<ServoControl>(batch, requests, settings, reports, rves);
}

TeamScratchBytes team_scratch_bytes(int grains, Precision precision) {
  const auto of = [=]<class real>(real) {
    using Scratch = TeamScratch<SingleLane<real>, StrainDrive, Space>;
    return TeamScratchBytes{Scratch::hot_bytes(grains), Scratch::cold_bytes(grains)};
  };
  return precision == Precision::float32 ? of(0.0F) : of(0.0);
}

}  // namespace voussoir::kernels
