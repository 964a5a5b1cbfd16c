#pragma once
/// Restores a team's RVE, and keeps its list valid while it moves.

#include "kernels/teams/team_lists.hpp"

namespace voussoir::kernels::teams {

/// Ends the RVE's course; all threads call it.
template <class Run>
KOKKOS_FUNCTION void end_course(const Run& run, RveStatus status) {
  alone(run, [&] {
    run.course().running = false;
    run.course().status = status;
  });
}

/// Makes the cell as wide as its lattice allows; false when nearest images are not unique even then.
template <class Run>
[[nodiscard]] KOKKOS_FUNCTION bool reduce_cell(const Run& run) {
  alone(run, [&] { run.shared().cell = reduced_lattice(run.shared().cell); });
  const Cell cell(run.shared().cell);
  each(run, run.grains, [&](int i) { cell.wrap(run.at.position(i, 0), run.at.position(i, 1)); });
  return wide_enough(cell, run.scales().largest_radius, run.scales().skin);
}

/// Replaces the reference positions by the current ones, x = F X + u, and the cell likewise; displacements and F stay
/// as they are.
template <class Run>
KOKKOS_FUNCTION void move_positions(const Run& run) {
  const Mat2 f = plus_identity(run.course().f_minus_i);
  each(run, run.grains, [&](int i) {
    const double x = run.at.position(i, 0), y = run.at.position(i, 1);
    run.at.position(i, 0) = f.xx * x + f.xy * y + static_cast<double>(run.at.grains(i).u_x[0]);
    run.at.position(i, 1) = f.yx * x + f.yy * y + static_cast<double>(run.at.grains(i).u_y[0]);
  });
  alone(run, [&] { run.shared().cell = current_cell(run.course(), run.shared().cell); });
}

/// Restores committed state, request and list. Where the RVE cannot run, its course ends at once, with the reason as
/// status.
template <class Run>
KOKKOS_FUNCTION void restore(const Run& run) {
  using V = typename Run::V;
  const auto& from = run.batch.committed;
  const int rve = run.rve;
  alone(run, [&] {
    RveCourse<typename Run::Drive> course;
    course.rve = rve;
    course.drive = run.batch.drives(rve);
    course.running = true;
    run.course() = course;
    run.shared().cell = {from.cell(rve, 0), from.cell(rve, 1), from.cell(rve, 2), from.cell(rve, 3)};
  });
  const V zero(0);
  each(run, run.grains, [&](int i) {
    run.at.position(i, 0) = from.position(rve, i, 0);
    run.at.position(i, 1) = from.position(rve, i, 1);
    run.at.grains(i) = {zero, zero, zero, zero, zero, zero, zero, zero, zero};
  });
  const Mat2 cell = run.shared().cell;  // read before the barrier in `count`, after which it is written to
  const int unknown = count(run, run.grains, [&](int i) {
    return !std::isfinite(run.at.position(i, 0)) || !std::isfinite(run.at.position(i, 1));
  });
  if (unknown > 0 || !run.course().drive.possible() || !std::isfinite(cell.norm()) || !(cell.det() > 0)) {
    return end_course(run, RveStatus::not_finite);
  }
  if (!reduce_cell(run)) return end_course(run, RveStatus::neighbour_overflow);
  const auto keys = Kokkos::subview(from.contact_key, rve, Kokkos::ALL);
  const auto histories = Kokkos::subview(from.contact_history, rve, Kokkos::ALL, Kokkos::ALL);
  if (!list_pairs(run, KeptContacts{keys, histories, from.contact_count(rve)})) {
    return end_course(run, RveStatus::neighbour_overflow);
  }
  alone(run, [&] { set_rate(run.course(), 0); });
}

/// Makes the current configuration the reference; histories are kept.
template <class Run>
KOKKOS_FUNCTION void rebase(const Run& run) {
  const auto& at = run.at;
  const int kept = pack(
      run, run.listed(), [&](int p) { return remembers<typename Run::Law>(at.pairs(p).history, 0); },
      [&](int p, int to) {
        at.kept_key(to) = pair_key(at.first(p), at.shapes(p).other);
        write_history<typename Run::Law>(at.pairs(p).history, 0, [&](int k, const typename Run::real& number) {
          at.kept_history(to, k) = static_cast<double>(number);
        });
      });
  move_positions(run);
  each(run, run.grains, [&](int i) { at.grains(i).u_x[0] = at.grains(i).u_y[0] = 0; });
  alone(run, [&] { run.course().f_minus_i = Mat2{}; });
  if (!reduce_cell(run) || !list_pairs(run, KeptContacts{at.kept_key, at.kept_history, kept})) {
    return end_course(run, RveStatus::neighbour_overflow);
  }
  alone(run, [&] { round_motion(run.course(), run.shared().motion, 0); });
}

/// Looks at displacements, on the RVE's own steps, and renews the list where two grains may meet whose pair is not
/// listed.
template <class Run>
KOKKOS_FUNCTION void check_list(const Run& run, int step) {
  using V = typename Run::V;
  using real = typename Run::real;
  const auto& grains = run.at.grains;
  const auto squared = [&](const V& x, const V& y) { return static_cast<real>(fused(x, x, y * y)); };
  const int unknown = count(run, run.grains,
                            [&](int i) { return !std::isfinite(squared(grains(i).u_x, grains(i).u_y)); });
  const real moved = largest<real>(run, run.grains, [&](int i) { return squared(grains(i).u_x, grains(i).u_y); });
  const real fastest = largest<real>(run, run.grains, [&](int i) { return squared(grains(i).w_x, grains(i).w_y); });
  alone(run, [&] {
    run.shared().list = look_at_list(run.course(), std::sqrt(static_cast<double>(moved)),
                                     std::sqrt(static_cast<double>(fastest)), unknown == 0, run.scales(),
                                     run.settings.list_interval, step);
  });
  switch (run.shared().list) {
    case ListState::valid:
      break;
    case ListState::stale:
      rebase(run);
      break;
    case ListState::not_finite:
      end_course(run, RveStatus::not_finite);
      break;
    case ListState::flown:
      end_course(run, RveStatus::overlap_limit);
      break;
  }
}

}  // namespace voussoir::kernels::teams
