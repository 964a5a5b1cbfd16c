#pragma once
/// The time loop of a block: it brings one RVE from its committed to its trial state.

#include "kernels/course/flush_subnormals.hpp"
#include "kernels/device/block_tangent.hpp"

namespace voussoir::kernels::device {

/// Judges a measuring step and moves the cell on. One thread calls it.
template <class Run>
KOKKOS_INLINE_FUNCTION void judge_step(Run& run, int step, const SweepSums<SingleLane<double>>& sums) {
  auto& course = run.course();
  Measurement seen;
  const Outcome outcome = judge(course, step, run.settings, sums, 0, run.at.control->cell, run.scales(), seen);
  course.running = outcome == Outcome::running;
  if constexpr (std::is_same_v<typename Run::Drive, ServoControl>) {
    if (outcome != Outcome::lost && course.drive.samples(step)) {
      const int at = run.batch.sample_count[run.rve]++;
      run.batch.samples[static_cast<std::size_t>(run.rve) * static_cast<std::size_t>(run.batch.sample_room) +
                        static_cast<std::size_t>(at)] = course.drive.sample(step, seen);
    }
  }
}

/// One step, after which the cell's next motion is ready.
template <Sweep mode, class Run>
KOKKOS_FORCEINLINE_FUNCTION void take_step(Run& run, int step) {
  auto* const motion = run.at.control->motion;
  const CellMotion<typename Run::V> now = motion[step & 1];
  StepSums sums;
  press_pairs<mode>(run, now, sums);
  run.block.barrier();
  if (mode == Sweep::advance && run.block.thread() == run.block.threads() - 1)
    move_cell(run.course(), step + 1, motion[(step + 1) & 1], 0);
  move_grains<mode>(run, now, sums);
  run.block.barrier();
  if constexpr (mode == Sweep::measure) {
    const auto all = sums_of_all(run, sums);
    alone(run, [&] {
      judge_step(run, step, all);
      if (run.course().running) move_cell(run.course(), step + 1, motion[(step + 1) & 1], 0);
    });
  }
}

/// Advances the RVE until its course ends.
template <class Run>
KOKKOS_INLINE_FUNCTION void follow_course(Run& run) {
  auto* const motion = run.at.control->motion;
  alone(run, [&] {
    if (run.course().running) move_cell(run.course(), 0, motion[0], 0);
  });
  for (int step = 0; run.course().running; ++step) {
    if (step >= run.course().next_list_check) {
      check_list(run, step, motion[step & 1]);
      if (!run.course().running) break;
    }
    // The course is written to only after the barrier that follows the pairs.
    if (guards(run.settings, step) || run.course().drive.looks(step)) {
      take_step<Sweep::measure>(run, step);
    } else {
      take_step<Sweep::advance>(run, step);
    }
  }
}

/// Writes the RVE's report and trial state. An RVE that failed has no trial state.
template <class Run>
KOKKOS_INLINE_FUNCTION void finish(Run& run) {
  RveReport& report = run.batch.reports[run.number];
  CellMotion<typename Run::V>& cell = run.at.control->motion[0];
  alone(run, [&] { begin_report(run.course(), report); });
  if (is_failure(report.status)) return;
  answer(run, cell);
  if (is_failure(report.status)) return;
  const double volume = report.cell_area * run.scales().thickness;
  const CellMotion<typename Run::V> last = cell;
  const bool stored = store(run, report.contacts, last);
  if (!stored) {
    run.block.barrier();  // all threads have read the status
    return alone(run, [&] { report.status = RveStatus::neighbour_overflow; });
  }
  if (run.settings.tangent != TangentKind::contact) find_tangent(run, last, volume);
}

/// Brings the block's RVE from its committed to its trial state.
template <class Run>
KOKKOS_INLINE_FUNCTION void advance_block(Run& run) {
  const FlushSubnormals flush;
  restore(run);
  follow_course(run);
  finish(run);
}

}  // namespace voussoir::kernels::device
