#include "kernels/advance_rves.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <memory>
#include <numeric>
#include <type_traits>
#include <vector>

#include "kernels/course/flush_subnormals.hpp"
#include "kernels/lanes/advance_group.hpp"
#include "kernels/state/schedule.hpp"
#include "kernels/teams/advance_teams.hpp"

namespace voussoir::kernels {

namespace {

/// RVEs of one packing side by side, most work first, so that lanes end together and the longest group starts first.
template <int width, class Request>
std::vector<GroupMembers<width>> form_groups(const RveBatch& batch, std::span<const Request> requests,
                                             std::span<const int> rves) {
  std::vector<int> order(rves.begin(), rves.end());
  const auto steps = [&](int rve) { return predicted_steps(requests[static_cast<std::size_t>(rve)]); };
  const auto packing = [&](int rve) { return batch.packing_of[static_cast<std::size_t>(rve)]; };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return packing(a) != packing(b) ? packing(a) < packing(b) : steps(a) > steps(b);
  });
  std::vector<GroupMembers<width>> groups;
  int lane = width;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (lane == width || packing(order[k]) != packing(order[k - 1])) {
      groups.emplace_back().fill(-1);
      lane = 0;
    }
    groups.back()[static_cast<std::size_t>(lane++)] = order[k];
  }
  std::stable_sort(groups.begin(), groups.end(),
                   [&](const auto& a, const auto& b) { return steps(a[0]) > steps(b[0]); });
  return groups;
}

template <int width>
Work count_work(const RveBatch& batch, const std::vector<GroupMembers<width>>& groups,
                std::span<const RveReport> reports) {
  Work work;
  for (const auto& group : groups) {
    const auto grains = static_cast<std::size_t>(batch.packing(static_cast<std::size_t>(group[0])).size());
    int longest = 0;
    for (const int rve : group) {
      if (rve < 0) continue;
      const int steps = reports[static_cast<std::size_t>(rve)].steps;
      work.particle_steps += grains * static_cast<std::size_t>(steps);
      longest = std::max(longest, steps);
    }
    work.lane_steps += grains * static_cast<std::size_t>(longest) * static_cast<std::size_t>(width);
  }
  return work;
}

template <class V, bool Rolling, class Drive>
Work launch(RveBatch& batch, std::span<const typename Drive::Request> requests, const EngineSettings& settings,
            std::span<RveReport> reports, std::span<const int> rves) {
  using Space = Kokkos::DefaultHostExecutionSpace;
  using Run = GroupRun<V, Drive>;
  using Law = LinearContactLaw<V, Rolling>;
  const auto groups = form_groups<lane_count<V>>(batch, requests, rves);
  const Space space;
  Kokkos::Experimental::UniqueToken<Space> tokens(space);
  std::vector<std::unique_ptr<Run>> workers(static_cast<std::size_t>(tokens.size()));
  for (auto& worker : workers) worker = std::make_unique<Run>();
  std::exception_ptr failure;
  std::atomic_flag failed;
  Kokkos::parallel_for(
      "voussoir::advance_rves::groups",
      Kokkos::RangePolicy<Space, Kokkos::Schedule<Kokkos::Dynamic>>(space, 0, groups.size()).set_chunk_size(1),
      [&](std::size_t g) {
        const FlushSubnormals flush;
        const auto token = tokens.acquire();
        try {
          advance_group<Law>(*workers[static_cast<std::size_t>(token)], batch, groups[g], requests, settings, reports);
        } catch (...) {  // no memory, say: nothing may leave the parallel region but through here
          if (!failed.test_and_set()) failure = std::current_exception();
        }
        tokens.release(token);
      });
  space.fence("voussoir::advance_rves::groups");
  if (failure) std::rethrow_exception(failure);
  return count_work<lane_count<V>>(batch, groups, reports);
}

/// One RVE per packing leaves wide lanes empty: those run one to a group in the same code.
bool mostly_alone(const RveBatch& batch) { return batch.size() < 2 * batch.packings.size(); }

template <class Drive, class real>
Work choose(RveBatch& batch, std::span<const typename Drive::Request> requests, const EngineSettings& settings,
            std::span<RveReport> reports, std::span<const int> rves) {
  using Wide = WideLane<real>;
  using Single = SingleLane<real>;
  if (mostly_alone(batch)) {
    return rolls(batch) ? launch<Single, true, Drive>(batch, requests, settings, reports, rves)
                        : launch<Single, false, Drive>(batch, requests, settings, reports, rves);
  }
  return rolls(batch) ? launch<Wide, true, Drive>(batch, requests, settings, reports, rves)
                      : launch<Wide, false, Drive>(batch, requests, settings, reports, rves);
}

template <class Drive>
Work advance_with(RveBatch& batch, std::span<const typename Drive::Request> requests, const EngineSettings& settings,
                  std::span<RveReport> reports, std::span<const int> rves) {
  return settings.precision == Precision::float32 ? choose<Drive, float>(batch, requests, settings, reports, rves)
                                                  : choose<Drive, double>(batch, requests, settings, reports, rves);
}

std::vector<int> all_of(const RveBatch& batch) {
  std::vector<int> rves(batch.size());
  std::iota(rves.begin(), rves.end(), 0);
  return rves;
}

bool wants_lanes(const StrainRequest&) { return false; }
bool wants_lanes(const ServoRequest& r) { return r.microstructure.any(); }

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
  if (runs_teams(settings, requests)) return advance_teams(batch, requests, settings, reports, rves);
  return advance_with<StrainDrive>(batch, requests, settings, reports, rves);
}

Work advance(RveBatch& batch, std::span<const ServoRequest> requests, const EngineSettings& settings,
             std::span<RveReport> reports) {
  const std::vector<int> rves = all_of(batch);
  if (runs_teams(settings, requests)) return advance_teams(batch, requests, settings, reports, rves);
  return advance_with<ServoDrive>(batch, requests, settings, reports, rves);
}

}  // namespace voussoir::kernels
