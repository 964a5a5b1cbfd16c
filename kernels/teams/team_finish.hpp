#pragma once
/// The end of a team's RVE: stress, tangent, report, and its trial state.

#include "kernels/course/rve_report.hpp"
#include "kernels/teams/team_rebase.hpp"
#include "kernels/teams/team_step.hpp"

namespace voussoir::kernels::teams {

/// Entry `c` of the tangent's upper triangle, summed in the order of the list.
template <class Run>
[[nodiscard]] KOKKOS_FUNCTION typename Run::V tangent_sum(const Run& run, int c) {
  typename Run::V sum(0);
  for (int p = 0; p < run.listed(); ++p) {
    const auto& springs = run.at.springs(p);
    sum = springs.tangential.added_to(c, springs.normal.added_to(c, sum));
  }
  return sum;
}

/// The sum of the contacts' overlaps, in the order of the list.
template <class Run>
[[nodiscard]] KOKKOS_FUNCTION typename Run::V overlap_sum(const Run& run) {
  typename Run::V sum(0);
  for (int p = 0; p < run.listed(); ++p)
    sum = sum + overlap_ratio(run.at.branches(p).overlap, run.at.springs(p).weight);
  return sum;
}

/// Computes all pairs at rest, and their sums.
template <class Run>
KOKKOS_FUNCTION void homogenise_team(const Run& run) {
  using V = typename Run::V;
  using real = typename Run::real;
  const auto& at = run.at;
  Homogenised<V>& out = run.shared().rest;
  const CellMotion<V>& cell = run.shared().motion;
  const int contacts = count(run, run.listed(), [&](int p) {
    const int i = at.first(p);
    const GrainLanes<V>&gi = at.grains(i), &gj = at.grains(at.shapes(p).other);
    const PairGeometry<V> now = geometry_of(at.pairs(p), cell, gj.u_x - gi.u_x, gj.u_y - gi.u_y);
    const RestingPair<V> pair = rest(at.pairs(p), at.shapes(p), now, cell, V(run.shape(i).radius));
    at.actions(p) = pair.action;
    at.branches(p) = {now.branch_x, now.branch_y, pair.overlap};
    at.springs(p) = {pair.normal, pair.tangential, pair.weight};
    return pair.weight[0] > 0;
  });
  const real overlap = largest_measure(run);
  each(run, 12, [&](int q) {
    if (q < 4) set_stress(out.sums, q, stress_sum(run, q));
    if (q >= 4 && q < 10) out.tangent[q - 4] = tangent_sum(run, q - 4);
    if (q == 10) {
      out.contacts = V(static_cast<real>(contacts));
      out.sums.largest_measure = V(overlap);
    }
    if (q == 11) out.overlaps = overlap_sum(run);
  });
}

/// Stores the final configuration as trial state. False where contacts have no room or the cell has become too narrow.
template <class Run>
[[nodiscard]] KOKKOS_FUNCTION bool store(const Run& run, int contacts) {
  const auto& at = run.at;
  const auto& to = run.batch.trial;
  const int rve = run.rve;
  move_positions(run);
  if (contacts > static_cast<int>(to.contact_key.extent(1)) || !reduce_cell(run)) return false;
  each(run, run.grains, [&](int i) {
    to.position(rve, i, 0) = at.position(i, 0);
    to.position(rve, i, 1) = at.position(i, 1);
    to.rotation(rve, i) = run.batch.committed.rotation(rve, i) + run.course().rotation +
                          static_cast<double>(at.grains(i).rotation[0]);
  });
  pack(
      run, run.listed(), [&](int p) { return at.springs(p).weight[0] > 0; },
      [&](int p, int c) {
        to.contact_key(rve, c) = pair_key(at.first(p), at.shapes(p).other);
        write_history<typename Run::Law>(at.pairs(p).history, 0, [&](int k, const typename Run::real& number) {
          to.contact_history(rve, c, k) = static_cast<double>(number);
        });
      });
  alone(run, [&] {
    const Mat2 cell = run.shared().cell;
    to.cell(rve, 0) = cell.xx;
    to.cell(rve, 1) = cell.xy;
    to.cell(rve, 2) = cell.yx;
    to.cell(rve, 3) = cell.yy;
    to.contact_count(rve) = contacts;
  });
  return true;
}

/// Makes the committed state the trial state, for an RVE that failed.
template <class Run>
KOKKOS_FUNCTION void keep_committed(const Run& run) {
  const auto& from = run.batch.committed;
  const auto& to = run.batch.trial;
  const int rve = run.rve;
  each(run, run.grains, [&](int i) {
    to.position(rve, i, 0) = from.position(rve, i, 0);
    to.position(rve, i, 1) = from.position(rve, i, 1);
    to.rotation(rve, i) = from.rotation(rve, i);
  });
  each(run, from.contact_count(rve), [&](int c) {
    to.contact_key(rve, c) = from.contact_key(rve, c);
    for (int k = 0; k < history_size<typename Run::Law>; ++k) {
      to.contact_history(rve, c, k) = from.contact_history(rve, c, k);
    }
  });
  alone(run, [&] {
    for (int k = 0; k < 4; ++k) to.cell(rve, k) = from.cell(rve, k);
    to.contact_count(rve) = from.contact_count(rve);
  });
}

/// Reports stress, tangent and status of an RVE that was not lost on the way.
template <class Run>
KOKKOS_FUNCTION void answer(const Run& run) {
  const auto& at = run.at;
  alone(run, [&] { round_motion(run.course(), run.shared().motion, 0); });
  homogenise_team(run);
  const int unknown = count(run, run.grains, [&](int i) {
    const auto& g = at.grains(i);
    return !std::isfinite(g.u_x[0] + g.u_y[0] + g.rotation[0]);
  });
  alone(run, [&] {
    const double volume = current_cell(run.course(), run.shared().cell).det() * run.scales().thickness;
    fill_report(run.course(), run.shared().rest, 0, volume, unknown == 0, run.scales(), run.settings,
                run.batch.reports(run.rve));
  });
}

/// Writes the RVE's report and trial state. An RVE that failed keeps its committed state as trial state.
template <class Run>
KOKKOS_FUNCTION void finish(const Run& run) {
  RveReport& report = run.batch.reports(run.rve);
  alone(run, [&] { begin_report(run.course(), report); });
  if (!is_failure(report.status)) answer(run);
  const bool stored = !is_failure(report.status) && store(run, report.contacts);
  if (stored) return;
  alone(run, [&] {
    if (!is_failure(report.status)) report.status = RveStatus::neighbour_overflow;
  });
  keep_committed(run);
}

}  // namespace voussoir::kernels::teams
