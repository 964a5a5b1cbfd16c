#pragma once
/// Brings one group from its committed to its trial states: it is restored, goes through the time loop, in which lanes
/// that have ended stand still, and is finished.

#include "kernels/lanes/finish.hpp"
#include "kernels/lanes/rebase.hpp"
#include "kernels/lanes/record.hpp"
#include "kernels/lanes/restore.hpp"
#include "kernels/lanes/sweep.hpp"

namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES {

template <class Run>
[[nodiscard]] bool any_running(const Run& run) {
  for (const auto& lane : run.lanes) {
    if (lane.running) return true;
  }
  return false;
}

template <class Run>
[[nodiscard]] bool measures(const Run& run, int step) {
  if (guards(run.settings, step)) return true;
  for (const auto& lane : run.lanes) {
    if (lane.running && lane.drive.looks(step)) return true;
  }
  return false;
}

template <class Run>
void move_cells(Run& run, int step) {
  for (std::size_t l = 0; l < Run::width; ++l) move_cell(run.lanes[l], step, run.group.motion, l);
}

/// Acts on a measuring step: lanes that are lost are given up, lanes at their end are frozen.
template <class Run>
void judge_lanes(Run& run, int step, const SweepSums<typename Run::Value>& sums) {
  for (std::size_t l = 0; l < Run::width; ++l) {
    auto& lane = run.lanes[l];
    if (!lane.running) continue;
    Measurement seen;
    switch (judge(lane, step, run.settings, sums, l, run.lists[l].cell, run.scales, seen)) {
      case Outcome::running:
        break;
      case Outcome::ended:
        freeze(run, l, lane.status);
        break;
      case Outcome::lost:
        discard(run, l, lane.status);
        break;
    }
  }
}

/// Advances the group of `members`. @param requests, reports by RVE
template <class Run>
void advance_group(Run& run, RveBatch& batch, const GroupMembers<static_cast<int>(Run::width)>& members,
                   std::span<const typename Run::Drive::Request> requests, const EngineSettings& settings,
                   std::span<RveReport> reports) {
  run.batch = &batch;
  run.settings = settings;
  run.packing = &batch.packing(static_cast<std::size_t>(members[0]));
  restore(run, members, requests);
  for (int step = 0; any_running(run); ++step) {
    move_cells(run, step);
    check_lists(run, step);
    record_microstructures(run, step);
    SweepSums<typename Run::Value> sums;
    const bool measure = measures(run, step);
    {
      const Region region(run.regions, "sweep");
      measure ? sweep_pairs<Sweep::measure>(run.group, sums) : sweep_pairs<Sweep::advance>(run.group, sums);
    }
    if (measure) judge_lanes(run, step, sums);
  }
  finish(run, reports);
}

}  // namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES
