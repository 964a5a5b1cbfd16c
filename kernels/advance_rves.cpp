#include "kernels/advance_rves.hpp"

#include <algorithm>
#include <numeric>
#include <type_traits>
#include <vector>

#include "kernels/isa/choose_lanes.hpp"
#include "kernels/teams/advance_teams.hpp"

namespace voussoir::kernels {

namespace {

std::vector<int> all_of(const RveBatch& batch) {
  std::vector<int> rves(batch.size());
  std::iota(rves.begin(), rves.end(), 0);
  return rves;
}

bool wants_lanes(const StrainRequest&) { return false; }
bool wants_lanes(const ServoRequest& r) { return r.microstructure.any(); }

/// To be called before trial states are written.
void forget_motions(RveBatch& batch, std::span<const int> rves) {
  for (const int rve : rves) batch.candidates.spending[static_cast<std::size_t>(rve)] = -1.0;
}

/// Only lanes solve for static tangents and record microstructures.
template <class Request>
bool runs_teams(const EngineSettings& settings, std::span<const Request> requests) {
  if (settings.backend != Backend::automatic) return settings.backend == Backend::teams;
  return takes_teams(settings.backend) && settings.tangent == TangentKind::contact &&
         std::none_of(requests.begin(), requests.end(), [](const Request& r) { return wants_lanes(r); });
}

}  // namespace

bool takes_teams(Backend backend) {
  constexpr bool has_device = !std::is_same_v<Kokkos::DefaultExecutionSpace, Kokkos::DefaultHostExecutionSpace>;
  return backend == Backend::teams || (backend == Backend::automatic && has_device);
}

Work advance(RveBatch& batch, std::span<const StrainRequest> requests, const EngineSettings& settings,
             std::span<RveReport> reports) {
  return advance(batch, requests, settings, reports, all_of(batch));
}

Work advance(RveBatch& batch, std::span<const StrainRequest> requests, const EngineSettings& settings,
             std::span<RveReport> reports, std::span<const int> rves) {
  forget_motions(batch, rves);
  if (runs_teams(settings, requests)) return teams::advance(batch, requests, settings, reports, rves);
  return chosen_lanes().lanes->advance_given(batch, requests, settings, reports, rves);
}

Work advance(RveBatch& batch, std::span<const ServoRequest> requests, const EngineSettings& settings,
             std::span<RveReport> reports) {
  const std::vector<int> rves = all_of(batch);
  forget_motions(batch, rves);
  if (runs_teams(settings, requests)) return teams::advance(batch, requests, settings, reports, rves);
  return chosen_lanes().lanes->advance_servo(batch, requests, settings, reports, rves);
}

}  // namespace voussoir::kernels
