#pragma once
/// Brings committed states into the lanes of a group.

#include <algorithm>
#include <cmath>
#include <span>

#include "kernels/lanes/group_run.hpp"

namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES {

/// The candidates of an RVE, which are looked for anew where grains may have come too near since they were found.
template <class Run>
[[nodiscard]] const std::vector<std::uint32_t>& candidates_of(Run& run, const LaneListOf<typename Run::Law>& list,
                                                              std::size_t rve) {
  constexpr double widening = 1.5;  // lists then hold over some increments, and a tenth more pairs is looked at
  CandidateCache& cache = run.batch->candidates;
  const double skin = run.scales.skin;
  if (cache.skin[rve] < 0 || cache.spent[rve] > cache.skin[rve] - skin) {
    const Cell cell(list.cell);
    const bool has_room = wide_enough(cell, run.scales.largest_radius, widening * skin);
    cache.skin[rve] = has_room ? widening * skin : skin;
    cache.spent[rve] = 0;
    find_candidates(list.position, run.packing->radii, cell, cache.skin[rve], cache.keys[rve]);
  }
  return cache.keys[rve];
}

/// Makes the committed state of the lane's RVE the lane's reference. False, with the reason as status, for a lane that
/// cannot run, which then stays empty.
template <class Run>
[[nodiscard]] bool restore_lane(Run& run, std::size_t l) {
  auto& lane = run.lanes[l];
  auto& list = run.lists[l];
  const auto rve = static_cast<std::size_t>(lane.rve);
  const RveStates& from = run.batch->committed;
  const std::size_t n = run.group.grains.size();
  list.cell = {from.cell(rve, 0), from.cell(rve, 1), from.cell(rve, 2), from.cell(rve, 3)};
  list.position.assign(&from.position(rve, 0, 0), &from.position(rve, 0, 0) + 2 * n);
  const bool finite = std::isfinite(list.cell.norm()) && std::all_of(list.position.begin(), list.position.end(),
                                                                     [](double x) { return std::isfinite(x); });
  if (!lane.drive.possible() || !finite || !(list.cell.det() > 0)) {
    lane.status = RveStatus::not_finite;
    return false;
  }
  if (!reduce_cell(run, list)) {
    lane.status = RveStatus::neighbour_overflow;
    return false;
  }
  const std::vector<std::uint32_t>& candidates = candidates_of(run, list, rve);
  const KeptContacts kept{{&from.contact_key(rve, 0), static_cast<std::size_t>(from.contact_count(rve))},
                          from.histories_of(rve)};
  list_pairs<typename Run::Law>(list, run.packing->radii, run.scales.skin, candidates, kept);
  list.rebased = false;
  set_rate(lane, 0);
  return true;
}

/// Empties all lanes: sets the grains' constants, and their motions to zero.
template <class Run>
void begin_group(Run& run) {
  using V = typename Run::Value;
  const Packing& packing = *run.packing;
  const std::size_t n = packing.radii.size();
  run.scales = scales_of<typename Run::Law>(packing, run.settings);
  run.lanes.fill({});
  run.steps_before.fill(0);
  for (auto& list : run.lists) list.pairs.clear();
  run.group.n_grains = packing.size();
  run.group.local_damping = packing.local_damping;
  run.group.grains.assign(n, GrainLanes<V>{V(0), V(0), V(0), V(0), V(0), V(0), V(0), V(0), V(0)});
  run.group.shapes.resize(n);
  run.group.row.resize(n + 1);
  for (std::size_t i = 0; i < n; ++i) {
    run.group.shapes[i] = grain_shape<typename Run::Law>(packing, i, run.scales.largest_radius,
                                                         run.settings.overlap_limit);
  }
}

template <class Run>
VOUSSOIR_OWN_SYMBOL void restore(Run& run, const GroupMembers<static_cast<int>(Run::width)>& members,
                                 std::span<const typename Run::Drive::Request> requests) {
  const Region region(run.regions, "restore");
  begin_group(run);
  for (std::size_t l = 0; l < Run::width; ++l) {
    if (members[l] < 0) continue;
    run.lanes[l].rve = members[l];
    run.lanes[l].drive = typename Run::Drive(requests[static_cast<std::size_t>(members[l])], run.scales, run.settings);
    run.lanes[l].running = restore_lane(run, l);
  }
  run.builder.build(run.group, run.lists, *run.packing);
}

}  // namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES
