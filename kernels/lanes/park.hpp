#pragma once
/// Lanes that leave their group before it is finished. A group waits for its slowest lane; so its last lanes are put
/// aside. They go on beside those of other groups of their packing, or alone, spread over all lanes. A lane takes all
/// its numbers with it as they are, so that where it runs changes no bit of them.

#include <span>
#include <utility>
#include <vector>

#include "kernels/lanes/restore.hpp"

namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES {

/// The motion of one grain of a lane between two steps, when the sums of its forces are zero (GrainLanes).
template <class real>
struct ParkedGrain {
  real u_x, u_y, w_x, w_y, spin, rotation;
};

/// A lane between two steps.
template <class real, std::size_t numbers, class Drive>
struct ParkedLane {
  RveCourse<Drive> course;
  int next_step = 0;             ///< of its course
  LaneList<real, numbers> list;  ///< with the histories of now
  std::vector<ParkedGrain<real>> grains;
};

template <class Run>
using ParkedLaneOf = ParkedLane<typename Run::real, static_cast<std::size_t>(history_size<typename Run::Law>),
                                typename Run::Drive>;

/// Takes lane `l`, which may have ended, out of its group, which has made all steps before `step`.
template <class Run>
[[nodiscard]] ParkedLaneOf<Run> park(Run& run, std::size_t l, int step) {
  ParkedLaneOf<Run> out;
  gather_spread(run);
  if (!is_failure(run.lanes[l].status)) gather_lane<typename Run::Law>(run.group, l, run.lists[l].pairs);
  out.next_step = step_of(run, l, step);
  out.course = std::exchange(run.lanes[l], {});
  out.list = std::exchange(run.lists[l], {});
  out.grains.reserve(run.group.grains.size());
  for (auto& g : run.group.grains) {
    out.grains.push_back({g.u_x[l], g.u_y[l], g.w_x[l], g.w_y[l], g.spin[l], g.rotation[l]});
  }
  discard(run, l, RveStatus::converged);
  return out;
}

/// Makes a group of parked lanes of one packing, at most one a lane. They are moved from.
template <class Run>
VOUSSOIR_OWN_SYMBOL void unpark(Run& run, std::span<ParkedLaneOf<Run>> parked) {
  const Region region(run.regions, "restore");
  begin_group(run);
  for (std::size_t l = 0; l < parked.size(); ++l) {
    run.lanes[l] = std::move(parked[l].course);
    run.lists[l] = std::move(parked[l].list);
    run.steps_before[l] = parked[l].next_step;
    for (std::size_t i = 0; i < run.group.grains.size(); ++i) {
      auto& to = run.group.grains[i];
      const auto& from = parked[l].grains[i];
      to.u_x[l] = from.u_x;
      to.u_y[l] = from.u_y;
      to.w_x[l] = from.w_x;
      to.w_y[l] = from.w_y;
      to.spin[l] = from.spin;
      to.rotation[l] = from.rotation;
    }
  }
  run.builder.build(run.group, run.lists, *run.packing);
}

}  // namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES
