#include "kernels/teams/advance_teams.hpp"

#include "kernels/course/choose_instance.hpp"
#include "kernels/teams/team_launch.hpp"

namespace voussoir::kernels::teams {

namespace {

using Space = Kokkos::DefaultExecutionSpace;

template <class Drive>
Work advance_with(RveBatch& batch, std::span<const typename Drive::Request> requests, const EngineSettings& settings,
                  std::span<RveReport> reports, std::span<const int> rves) {
  return choose_instance<SingleLane>(batch, settings.precision, [&]<class Law>(Instance<Law>) {
    return launch_teams<Law, Drive, Space>(batch, requests, settings, reports, rves);
  });
}

}  // namespace

Work advance(RveBatch& batch, std::span<const StrainRequest> requests, const EngineSettings& settings,
             std::span<RveReport> reports, std::span<const int> rves) {
  return advance_with<StrainDrive>(batch, requests, settings, reports, rves);
}

Work advance(RveBatch& batch, std::span<const ServoRequest> requests, const EngineSettings& settings,
             std::span<RveReport> reports, std::span<const int> rves) {
  return advance_with<ServoControl>(batch, requests, settings, reports, rves);
}

TeamScratchBytes team_scratch_bytes(int grains, Precision precision) {
  return choose_precision(precision, [=]<class real>(Instance<real>) {
    using Scratch = TeamScratch<EngineLaw<SingleLane<real>, true>, StrainDrive, Space>;
    return TeamScratchBytes{Scratch::hot_bytes(grains), Scratch::cold_bytes(grains)};
  });
}

}  // namespace voussoir::kernels::teams
