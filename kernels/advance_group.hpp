#pragma once
/// One group from its committed states to its trial states: restore, time loop with masked retirement, finish.

#include "kernels/group_finish.hpp"
#include "kernels/group_rebase.hpp"
#include "kernels/group_restore.hpp"

namespace voussoir::kernels {

template <class Run>
[[nodiscard]] bool any_running(const Run& run) {
  for (const auto& lane : run.lanes) {
    if (lane.running) return true;
  }
  return false;
}

/// Looks at overlaps come on fixed steps, whatever a lane's neighbours do.
[[nodiscard]] inline bool guards(const EngineSettings& settings, int step) {
  return step % settings.guard_interval == settings.guard_interval - 1;
}

template <class Run>
[[nodiscard]] bool measures(const Run& run, int step) {
  if (guards(run.settings, step)) return true;
  for (const auto& lane : run.lanes) {
    if (lane.running && lane.drive.looks(step)) return true;
  }
  return false;
}

/// F <- exp(rate) F in double, then the lanes' rounded copies. A lane that is not running stands still.
template <class Run>
void move_cells(Run& run, int step) {
  using real = typename Run::real;
  auto& m = run.group.motion;
  for (std::size_t l = 0; l < Run::width; ++l) {
    auto& lane = run.lanes[l];
    if (!lane.running) lane.rate = lane.e = Mat2{};
    lane.f_minus_i = lane.e + lane.f_minus_i + lane.e * lane.f_minus_i;
    m.d_xx[l] = static_cast<real>(lane.rate.xx);
    m.d_xy[l] = static_cast<real>(0.5 * (lane.rate.xy + lane.rate.yx));
    m.d_yy[l] = static_cast<real>(lane.rate.yy);
    lane.rotation += 0.5 * (lane.rate.yx - lane.rate.xy);
    if (lane.running) {
      lane.steps = step + 1;
      set_rate(lane, step + 1);
    }
    round_motion(run, l);
  }
}

template <class Run>
[[nodiscard]] Measurement measurement_of(const Run& run, std::size_t l, const SweepSums<typename Run::Value>& sums) {
  const double v = volume_of(run, l);
  const Mat2 cell = (identity2 + run.lanes[l].f_minus_i) * run.lists[l].cell;
  Measurement m;
  m.stress_xx = sums.stress_xx[l] / v;
  m.stress_yy = sums.stress_yy[l] / v;
  m.stress_xy = 0.5 * (sums.stress_xy[l] + sums.stress_yx[l]) / v;
  m.width = cell.xx;
  m.height = cell.yy;
  const double p = std::max(-0.5 * (m.stress_xx + m.stress_yy), run.settings.pressure_floor);
  m.unbalanced = std::sqrt(static_cast<double>(sums.force_squared[l]) / run.group.n_grains) /
                 (p * run.packing->thickness * run.packing->mean_diameter());
  return m;
}

/// What a measuring step decides: overlaps beyond the limit are given up, lanes at their end are frozen.
template <class Run>
void judge(Run& run, int step, const SweepSums<typename Run::Value>& sums) {
  for (std::size_t l = 0; l < Run::width; ++l) {
    auto& lane = run.lanes[l];
    if (!lane.running) continue;
    if (guards(run.settings, step)) {
      lane.overlap = relative_overlap(static_cast<double>(sums.largest_overlap[l]));
      if (!(lane.overlap <= run.settings.overlap_limit)) {
        discard(run, l, RveStatus::overlap_limit);
        continue;
      }
    }
    if (!lane.drive.looks(step)) continue;
    const Measurement m = measurement_of(run, l, sums);
    lane.unbalanced = m.unbalanced;
    const Verdict verdict = lane.drive.judge(step, m);
    if (verdict == Verdict::running) continue;
    freeze(run, l, verdict == Verdict::converged ? RveStatus::converged : RveStatus::step_limit);
  }
}

/// @param requests, reports by RVE
template <class Law, class Run>
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
    SweepSums<typename Run::Value> sums;
    if (measures(run, step)) {
      sweep_pairs<Sweep::measure, Law>(run.group, sums);
      judge(run, step, sums);
    } else {
      sweep_pairs<Sweep::advance, Law>(run.group, sums);
    }
  }
  finish<Law>(run, reports);
}

}  // namespace voussoir::kernels
