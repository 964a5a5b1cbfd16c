#pragma once
/// Restores a block's RVE, and keeps its list valid while it moves.

#include "kernels/device/block_lists.hpp"

namespace voussoir::kernels::device {

/// Ends the RVE's course.
template <class Run>
KOKKOS_FORCEINLINE_FUNCTION void end_course(const Run& run, RveStatus status) {
  alone(run, [&] {
    run.course().running = false;
    run.course().status = status;
  });
}

/// Ends the course of an RVE whose list has no room; a block with more room runs it again.
template <class Run>
KOKKOS_FORCEINLINE_FUNCTION void overflow(const Run& run) {
  if (run.block.thread() == 0) run.batch.overflown[run.rve] = 1;
  end_course(run, RveStatus::neighbour_overflow);
}

/// Makes the cell as wide as its lattice allows; false when nearest images are not unique even then.
template <class Run>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION bool reduce_cell(const Run& run, double* position) {
  alone(run, [&] { run.at.control->cell = reduced_lattice(run.at.control->cell); });
  const Cell cell(run.at.control->cell);
  each(run, run.grains, [&](int i) { cell.wrap(position[2 * i], position[2 * i + 1]); });
  run.block.barrier();
  return wide_enough(cell, run.scales().largest_radius, run.scales().skin);
}

/// Replaces the reference positions by the current ones, x = F X + u, and the cell likewise; displacements and F stay
/// as they are.
template <class Run>
KOKKOS_FORCEINLINE_FUNCTION void move_positions(const Run& run, double* position) {
  const Mat2 f = plus_identity(run.course().f_minus_i);
  each(run, run.grains, [&](int i) {
    const double x = position[2 * i], y = position[2 * i + 1];
    position[2 * i] = f.xx * x + f.xy * y + static_cast<double>(run.at.motion[i].x);
    position[2 * i + 1] = f.yx * x + f.yy * y + static_cast<double>(run.at.motion[i].y);
  });
  run.block.barrier();
  alone(run, [&] { run.at.control->cell = current_cell(run.course(), run.at.control->cell); });
}

/// Sets the RVE's course and its grains at rest. Whether the state and the request can be run is the answer.
template <class Run>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION bool place_grains(Run& run, const DeviceState& from, const DeviceState& to) {
  using real = typename Run::real;
  alone(run, [&] {
    RveCourse<typename Run::Drive> course;
    course.rve = run.rve;
    course.drive = run.batch.drives[run.number];
    course.running = true;
    run.course() = course;
    run.at.control->cell = {from.cell[0], from.cell[1], from.cell[2], from.cell[3]};
    run.batch.overflown[run.rve] = 0;
    if (run.batch.sample_room > 0) run.batch.sample_count[run.rve] = 0;  // a block without room may have taken some
    run.batch.states.evaluated[run.rve] = 0;
    run.batch.candidates.spending[run.candidates()] = -1;
  });
  double unknown[1] = {0};
  each_grain(run, [&](int i) {
    const double x = from.position[2 * i], y = from.position[2 * i + 1];
    to.position[2 * i] = x;
    to.position[2 * i + 1] = y;
    if (!std::isfinite(x) || !std::isfinite(y)) unknown[0] = 1;
    const GrainShape<real>& shape = run.batch.packings.shapes[run.grain(i)];
    run.at.rotation[i] = 0;
    run.at.mobility[i] = {shape.mobility, shape.rotational_mobility};
    run.at.motion[i] = {0, 0, 0, 0};
    run.at.rim[i] = {0, shape.radius};
  });
  const Mat2 cell = run.at.control->cell;
  reduce_for_all<Largest>(run, unknown);
  return !(unknown[0] > 0) && run.course().drive.possible() && std::isfinite(cell.norm()) && cell.det() > 0;
}

/// Restores committed state, request and list. Where the RVE cannot run, its course ends at once, with the reason as
/// status. Returns the number of pairs.
template <class Run>
[[nodiscard]] VOUSSOIR_COLD_FUNCTION int restore(const typename Run::Seat seat) {
  Run run(seat);
  const DeviceState from = run.committed(), to = run.trial();
  const KeptContacts<double> kept{from.contact_key, from.contact_history, *from.contact_count};
  if (!place_grains(run, from, to)) {
    end_course(run, RveStatus::not_finite);
  } else if (!reduce_cell(run, to.position)) {
    end_course(run, RveStatus::neighbour_overflow);
  } else if (ensure_candidates(run, to.position) == Listing::too_many ||
             list_pairs(run, to.position, kept) == Listing::too_many) {
    overflow(run);
  } else {
    alone(run, [&] { set_rate(run.course(), 0); });
  }
  return run.listed;
}

/// Makes the current configuration the reference; histories are kept. Returns the number of pairs.
/// The motion of the cell at `step` is rounded anew.
template <class Run>
[[nodiscard]] VOUSSOIR_COLD_FUNCTION int rebase(const typename Run::Seat seat, const int step) {
  Run run(seat);
  using Law = typename Run::Law;
  using real = typename Run::real;
  const DeviceState to = run.trial();
  each_pair(run, [&](int p) {
    run.at.kept_key[p] = run.at.keys[p];
    write_history<Law>(pair_of(run, p).history, 0,
                       [&](int q, const real& number) { run.at.kept_history[p * history_size<Law> + q] = number; });
  });
  const int kept = run.listed;
  move_positions(run, to.position);
  each_grain(run, [&](int i) {
    const Four<real> m = run.at.motion[i];
    run.at.motion[i] = {0, 0, m.z, m.w};
  });
  alone(run, [&] {
    run.course().f_minus_i = Mat2{};
    run.batch.candidates.skin[run.candidates()] = -1;  // the candidates of the trial state's way are not those of the
                                                       // committed one
  });
  const KeptContacts<real> contacts{run.at.kept_key, run.at.kept_history, kept};
  if (!reduce_cell(run, to.position)) {
    end_course(run, RveStatus::neighbour_overflow);
  } else if (find_candidates(run, to.position, run.scales().skin) == Listing::too_many ||
             list_pairs(run, to.position, contacts) == Listing::too_many) {
    overflow(run);
  } else {
    alone(run, [&] { round_motion(run.course(), run.at.control->motion[step & 1], 0); });
  }
  return run.listed;
}

/// Looks at displacements, on the RVE's own steps: whether two grains may meet whose pair is not listed.
template <class Run>
[[nodiscard]] VOUSSOIR_COLD_FUNCTION ListState look_at_displacements(const typename Run::Seat seat, const int step) {
  const Run run(seat);
  const auto squared = [](double x, double y) { return x * x + y * y; };
  double own[3] = {0, 0, 0}, all[3] = {};
  each_grain(run, [&](int i) {
    const auto m = run.at.motion[i];
    const double moved = squared(static_cast<double>(m.x), static_cast<double>(m.y));
    own[0] = Largest()(own[0], moved);
    own[1] = Largest()(own[1], squared(static_cast<double>(m.z), static_cast<double>(m.w)));
    if (!std::isfinite(moved)) own[2] = 1;
  });
  reduce<Largest>(run, own, all);
  alone(run, [&] {
    run.at.control->list = look_at_list(run.course(), std::sqrt(all[0]), std::sqrt(all[1]), !(all[2] > 0), run.scales(),
                                        run.settings.list_interval, step);
  });
  const ListState list = run.at.control->list;
  run.block.barrier();
  return list;
}

/// Keeps the list valid, or ends the course. Returns the number of pairs.
template <class Run>
[[nodiscard]] VOUSSOIR_COLD_FUNCTION int check_list(typename Run::Seat seat, const int step) {
  const ListState list = look_at_displacements<Run>(seat, step);
  if (list == ListState::stale) return rebase<Run>(seat, step);
  if (list == ListState::not_finite) end_course(Run(seat), RveStatus::not_finite);
  if (list == ListState::flown) end_course(Run(seat), RveStatus::overlap_limit);
  return seat.listed;
}

}  // namespace voussoir::kernels::device
