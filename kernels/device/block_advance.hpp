#pragma once
/// The time loop of a block: it brings one RVE from its committed to its trial state.

#include "kernels/course/flush_subnormals.hpp"
#include "kernels/device/block_tangent.hpp"

namespace voussoir::kernels::device {

/// Whether the state is judged in a step.
template <class Run>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION bool measures_in(const Run& run, int step) {
  return guards(run.settings, step) || run.course().drive.looks(step);
}

/// Judges a measuring step. One thread calls it.
template <class Run>
KOKKOS_INLINE_FUNCTION void judge_step(const Run& run, int step, const SweepSums<SingleLane<double>>& sums) {
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

/// The last step of the segment that begins with `step`: the first one that is judged, or after which the list is
/// looked at or the cell's rate changes. One thread calls it.
template <class Run>
[[nodiscard]] KOKKOS_INLINE_FUNCTION int end_of_segment(const Run& run, int step) {
  const auto& course = run.course();
  for (int last = step;; ++last) {
    if (measures_in(run, last) || last + 1 >= course.next_list_check || !(course.drive.rate(last + 2) == course.rate))
      return last;
  }
}

/// The work before a segment: the list, and where the segment ends. Returns the number of pairs.
template <class Run>
[[nodiscard]] VOUSSOIR_COLD_FUNCTION int begin_segment(const typename Run::Seat seat, const int step) {
  const Run run(seat);
  int listed = seat.listed;
  if (step == 0) {
    alone(run, [&] {
      if (run.course().running) move_cell(run.course(), 0, run.at.control->motion[0], 0);
    });
  }
  if (run.course().running && step >= run.course().next_list_check) listed = check_list<Run>(seat, step);
  alone(run, [&] {
    if (run.course().running) run.at.control->last = end_of_segment(run, step);
  });
  return listed;
}

/// The work after a segment's last step: it is judged, and the cell moved on.
template <class Run>
VOUSSOIR_COLD_FUNCTION void end_segment(const typename Run::Seat seat, const int step,
                                        const StepSums<typename Run::real> sums) {
  const Run run(seat);
  SweepSums<SingleLane<double>> all;
  const bool measures = measures_in(run, step);
  if (measures) all = sums_of_all(run, sums);
  alone(run, [&] {
    if (measures) judge_step(run, step, all);
    if (run.course().running) move_cell(run.course(), step + 1, run.at.control->motion[(step + 1) & 1], 0);
  });
}

/// Takes the steps of a segment; returns the last one, to which the sums belong. Nothing is called here, because
/// registers would have to be emptied for it.
template <class Run>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION int run_segment(const Run& run, int step,
                                                          StepSums<typename Run::real>& sums) {
  BlockSlots<Run> held(run);
  held.load(run);
  const int last = run.at.control->last;
  auto* const motion = run.at.control->motion;
  for (; step < last; ++step) {
    press_pairs<Sweep::advance>(run, held, motion[step & 1], sums);
    run.block.barrier();
    if (run.block.thread() == run.block.threads() - 1) carry_cell(run.course(), step + 1, motion[(step + 1) & 1], 0);
    move_grains<Sweep::advance>(run, motion[step & 1], sums);
    run.block.barrier();
  }
  press_pairs<Sweep::measure>(run, held, motion[last & 1], sums);
  run.block.barrier();
  move_grains<Sweep::measure>(run, motion[last & 1], sums);
  held.store(run);
  return last;
}

/// Advances the RVE until its course ends, segment by segment.
template <class Run>
KOKKOS_FORCEINLINE_FUNCTION void follow_course(typename Run::Seat& seat) {
  for (int step = 0;; ++step) {
    seat.listed = begin_segment<Run>(seat, step);
    const Run run(seat);
    if (!run.course().running) return;
    StepSums<typename Run::real> sums;
    step = run_segment(run, step, sums);
    end_segment<Run>(seat, step, sums);
  }
}

/// Writes the RVE's report and trial state. An RVE that failed has no trial state.
template <class Run>
VOUSSOIR_COLD_FUNCTION void finish(const typename Run::Seat seat) {
  Run run(seat);
  RveReport& report = run.batch.reports[run.number];
  CellMotion<typename Run::V>& cell = run.at.control->motion[0];
  alone(run, [&] { begin_report(run.course(), report); });
  if (is_failure(report.status)) return;
  answer(run, cell);
  alone(run, [&] { give_up_crushed(report, run.batch.states.contacts); });
  if (is_failure(report.status)) return;
  const double volume = report.cell_area * run.scales().thickness;
  if (!store(run, report.contacts, cell)) {
    run.block.barrier();  // all threads have read the status
    return alone(run, [&] { report.status = RveStatus::neighbour_overflow; });
  }
  if (run.settings.tangent != TangentKind::contact) find_tangent<Run>(seat, volume);
}

/// Brings the block's RVE from its committed to its trial state.
template <class Run>
KOKKOS_FORCEINLINE_FUNCTION void advance_block(typename Run::Seat seat) {
  const FlushSubnormals flush;
  seat.listed = restore<Run>(seat);
  follow_course<Run>(seat);
  finish<Run>(seat);
}

}  // namespace voussoir::kernels::device
