#pragma once
/// The end of a block's RVE: stress, tangent, report, and its trial state.

#include "kernels/contact/resting_pair.hpp"
#include "kernels/device/block_rebase.hpp"
#include "kernels/device/block_step.hpp"

namespace voussoir::kernels::device {

/// Computes all pairs at rest, and their sums, which thread 0 alone receives.
template <class Run>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION Homogenised<SingleLane<double>> homogenise(
    Run& run, const CellMotion<typename Run::V>& cell) {
  using V = typename Run::V;
  using D = SingleLane<double>;
  enum : int { contacts = 4, overlaps = 5, sums = 6 };
  double own[sums] = {}, tangent[6] = {}, largest[1] = {0};
  each_pair(run, [&](int p) {
    const int i = first_of(run.at.keys[p]), j = second_of(run.at.keys[p]);
    const auto ri = run.at.rim[i].y, rj = run.at.rim[j].y;
    const PairGeometry<V> at = geometry_of_pair(run, p, cell);
    Homogenised<V> one;
    PairLanes<typename Run::Law> pair = pair_of(run, p);
    add_pair(one, rest(pair, shape_of(run, i, j, ri, rj), at, cell, V(ri)), at);
    set_history(run, p, pair.history);
    own[0] += static_cast<double>(one.sums.stress_xx[0]);
    own[1] += static_cast<double>(one.sums.stress_xy[0]);
    own[2] += static_cast<double>(one.sums.stress_yx[0]);
    own[3] += static_cast<double>(one.sums.stress_yy[0]);
    own[contacts] += static_cast<double>(one.contacts[0]);
    own[overlaps] += static_cast<double>(one.overlaps[0]);
    for (int c = 0; c < 6; ++c) tangent[c] += static_cast<double>(one.tangent[c][0]);
    largest[0] = Largest()(largest[0], static_cast<double>(one.sums.largest_measure[0]));
  });
  double all[sums] = {}, all_tangent[6] = {}, all_largest[1] = {};
  run.block.barrier();
  reduce<Add>(run, own, all);
  run.block.barrier();
  reduce<Add>(run, tangent, all_tangent);
  run.block.barrier();
  reduce<Largest>(run, largest, all_largest);
  Homogenised<D> out;
  out.sums = {D(all[0]), D(all[1]), D(all[2]), D(all[3]), D(0), D(all_largest[0])};
  for (int c = 0; c < 6; ++c) out.tangent[c] = D(all_tangent[c]);
  out.contacts = D(all[contacts]);
  out.overlaps = D(all[overlaps]);
  return out;
}

/// Stores the contacts at the final positions with their histories.
template <class Run>
KOKKOS_FORCEINLINE_FUNCTION void store_contacts(Run& run, const DeviceState& to,
                                                const CellMotion<typename Run::V>& cell) {
  using Law = typename Run::Law;
  int* const place = reinterpret_cast<int*>(run.at.action);
  each_pair(run, [&](int p) { place[p] = geometry_of_pair(run, p, cell).gap[0] < 0 ? 1 : 0; });
  run.block.barrier();
  const int all = sums_before(run, place, run.listed);
  each_pair(run, [&](int p) {
    const int c = place[p];
    if ((p + 1 < run.listed ? place[p + 1] : all) == c) return;
    to.contact_key[c] = run.at.keys[p];
    write_history<Law>(pair_of(run, p).history, 0, [&](int q, const auto& number) {
      to.contact_history[c * history_size<Law> + q] = static_cast<double>(number);
    });
  });
  if (run.block.thread() == 0) *to.contact_count = all;
  run.block.barrier();
}

/// Stores the final configuration as trial state. False where contacts have no room or the cell has become too narrow.
template <class Run>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION bool store(Run& run, int contacts, const CellMotion<typename Run::V>& cell) {
  const DeviceState from = run.committed(), to = run.trial();
  if (contacts > run.batch.states.contacts) return false;
  store_contacts(run, to, cell);
  each_grain(run, [&](int i) {
    to.rotation[i] = from.rotation[i] + run.course().rotation + static_cast<double>(run.at.rotation[i]);
  });
  move_positions(run, to.position);
  if (!reduce_cell(run, to.position)) return false;
  alone(run, [&] {
    const Mat2 h = run.at.control->cell;
    const double numbers[4] = {h.xx, h.xy, h.yx, h.yy};
    for (int k = 0; k < 4; ++k) to.cell[k] = numbers[k];
    run.batch.states.evaluated[run.rve] = 1;
  });
  return true;
}

/// Notes by how much grains may have come nearer, which decides how long the candidates hold, and tells all threads
/// whether all grains' motions are finite.
template <class Run>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION bool note_motion(Run& run) {
  double numbers[2] = {0, 0};
  each_grain(run, [&](int i) {
    const auto m = run.at.motion[i];
    const double x = static_cast<double>(m.x), y = static_cast<double>(m.y);
    numbers[0] = Largest()(numbers[0], x * x + y * y);
    if (!std::isfinite(x + y + static_cast<double>(run.at.rotation[i]))) numbers[1] = 1;
  });
  reduce_for_all<Largest>(run, numbers);
  const DeviceCandidates& of = run.batch.candidates;
  alone(run, [&] {
    const double skin = of.skin[run.candidates()];
    if (skin < 0) return;  // there was a rebase, and the motion before it is not known any more
    const double farthest = run.scales().reach + skin - run.scales().skin;
    of.spending[run.candidates()] = of.spent[run.candidates()] + 2.0 * std::sqrt(numbers[0]) +
                                    run.course().f_minus_i.norm() * farthest;
  });
  return !(numbers[1] > 0);
}

/// Reports stress, tangent and status of an RVE that was not lost on the way.
template <class Run>
KOKKOS_FORCEINLINE_FUNCTION void answer(Run& run, CellMotion<typename Run::V>& cell) {
  const bool finite = note_motion(run);
  alone(run, [&] { round_motion(run.course(), cell, 0); });
  const Homogenised<SingleLane<double>> sums = homogenise(run, cell);
  alone(run, [&] {
    const double volume = current_cell(run.course(), run.at.control->cell).det() * run.scales().thickness;
    fill_report(run.course(), sums, 0, volume, finite, run.scales(), run.settings, run.batch.reports[run.number]);
  });
}

}  // namespace voussoir::kernels::device
