#pragma once
/// Brings the lanes of one group to their trial states: the group goes through the time loop, in which lanes that have
/// ended stand still, and is finished.

#include <algorithm>

#include "kernels/lanes/finish.hpp"
#include "kernels/lanes/park.hpp"
#include "kernels/lanes/rebase.hpp"
#include "kernels/lanes/record.hpp"
#include "kernels/lanes/restore.hpp"
#include "kernels/lanes/sweep.hpp"
#include "kernels/state/stop_request.hpp"

namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES {

template <class Run>
[[nodiscard]] int running_lanes(const Run& run) {
  return static_cast<int>(
      std::count_if(run.lanes.begin(), run.lanes.end(), [](const auto& lane) { return lane.running; }));
}

/// Whether a lane looks at its stress or overlaps in this step.
template <class Run>
[[nodiscard]] bool measures(const Run& run, int step) {
  for (std::size_t l = 0; l < Run::width; ++l) {
    const int own = step_of(run, l, step);
    if (run.lanes[l].running && (guards(run.settings, own) || run.lanes[l].drive.looks(own))) return true;
  }
  return false;
}

template <class Run>
void move_cells(Run& run, int step) {
  for (std::size_t l = 0; l < Run::width; ++l) move_cell(run.lanes[l], step_of(run, l, step), run.group.motion, l);
}

template <Sweep mode, class Run>
void sweep(Run& run, SweepSums<typename Run::Value>& sums) {
  if constexpr (Run::is_spread) {
    if (!run.spread.holds()) run.spread.take(run.group);
    run.spread.template sweep<mode>(run.group.motion, run.group.local_damping, sums);
  } else {
    sweep_pairs<mode>(run.group, sums);
  }
}

/// Acts on a measuring step: lanes that are lost are given up, lanes at their end are frozen.
template <class Run>
void judge_lanes(Run& run, int step, const SweepSums<typename Run::Value>& sums) {
  for (std::size_t l = 0; l < Run::width; ++l) {
    auto& lane = run.lanes[l];
    if (!lane.running) continue;
    Measurement seen;
    switch (judge(lane, step_of(run, l, step), run.settings, sums, l, run.lists[l].cell, run.scales, seen)) {
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

/// Puts all lanes that run aside, before `step`.
template <class Run, class Queue>
void park_rest(Run& run, int step, Queue& queue) {
  const Region region(run.regions, "restore");
  for (std::size_t l = 0; l < Run::width; ++l) {
    if (run.lanes[l].running) queue.put_aside(park(run, l, step));
  }
}

/// Makes one step of all lanes of a group. True where lanes may have ended. @throws Stopped
template <class Run>
[[nodiscard]] bool advance_step(Run& run, int step) {
  move_cells(run, step);
  check_lists(run, step);
  record_microstructures(run, step);
  SweepSums<typename Run::Value> sums;
  const bool measure = measures(run, step);
  {
    const Region region(run.regions, "sweep");
    measure ? sweep<Sweep::measure>(run, sums) : sweep<Sweep::advance>(run, sums);
  }
  if (measure) {
    end_where_stopped(run.stop);
    judge_lanes(run, step, sums);
  }
  return measure;
}

/// Advances the lanes of a group until they have ended or the queue takes those that are left.
/// @param reports by RVE @return the steps that the group has made
template <class Run, class Queue>
int advance_group(Run& run, Queue& queue, std::span<RveReport> reports) {
  int step = 0;
  for (int running = running_lanes(run); running > 0; ++step) {
    if (advance_step(run, step) && queue.wants(*run.packing, running_lanes(run))) park_rest(run, step + 1, queue);
    running = running_lanes(run);
  }
  finish(run, reports);
  return step;
}

/// Advances the one lane of `run` to its end and returns it. @param steps receives the steps made
template <class Run>
[[nodiscard]] ParkedLaneOf<Run> advance_alone(Run& run, int& steps) {
  int step = 0;
  for (; run.lanes[0].running; ++step) static_cast<void>(advance_step(run, step));
  steps = step;
  return park(run, 0, step);
}

}  // namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES
