#pragma once
/// Groups of RVEs, and the parallel loop over them. Only advance_lanes.cpp and tests with a law of their own include
/// this file, because it takes long to compile.

#include <algorithm>
#include <atomic>
#include <exception>
#include <memory>
#include <stdexcept>
#include <vector>

#include "kernels/course/flush_subnormals.hpp"
#include "kernels/lanes/advance_group.hpp"

namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES {

/// Puts RVEs of one packing side by side, most work first, so that the lanes of a group end together and the longest
/// group starts first.
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

/// Advances the RVEs `rves` in groups on all cores of the host.
/// @throws std::invalid_argument where the batch's histories are not the law's
template <class Law, class Drive>
Work launch(RveBatch& batch, std::span<const typename Drive::Request> requests, const EngineSettings& settings,
            std::span<RveReport> reports, std::span<const int> rves) {
  using Space = Kokkos::DefaultHostExecutionSpace;
  using Run = GroupRun<Law, Drive>;
  constexpr int width = lane_count<typename Law::Value>;
  if (batch.committed.history_size() != static_cast<std::size_t>(history_size<Law>)) {
    throw std::invalid_argument("lanes: the batch holds the histories of another law");
  }
  const auto groups = form_groups<width>(batch, requests, rves);
  const Space space;
  Kokkos::Experimental::UniqueToken<Space> tokens(space);
  std::vector<std::unique_ptr<Run>> workers(static_cast<std::size_t>(tokens.size()));
  for (auto& worker : workers) worker = std::make_unique<Run>();
  RegionTeller teller;
  std::exception_ptr failure;
  std::atomic_flag failed;
  Kokkos::parallel_for(
      "voussoir::lanes::groups",
      Kokkos::RangePolicy<Space, Kokkos::Schedule<Kokkos::Dynamic>>(space, 0, groups.size()).set_chunk_size(1),
      [&](std::size_t g) {
        const FlushSubnormals flush;
        const auto token = tokens.acquire();
        try {
          Run& run = *workers[static_cast<std::size_t>(token)];
          const RegionTeller::Turn turn(teller);
          run.regions = turn.regions();
          advance_group(run, batch, groups[g], requests, settings, reports);
        } catch (...) {  // for example no memory; an exception may leave the parallel region only in this way
          if (!failed.test_and_set()) failure = std::current_exception();
        }
        tokens.release(token);
      });
  space.fence("voussoir::lanes::groups");
  if (failure) std::rethrow_exception(failure);
  return count_work<width>(batch, groups, reports);
}

}  // namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES
