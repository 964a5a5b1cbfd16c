#pragma once
/// Keeps neighbour lists valid while grains move. Each lane renews its list by its own displacements, at steps of its
/// own.

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernels/lanes/group_run.hpp"

namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES {

/// The largest displacement and velocity of a group's grains, for each lane.
template <class V>
struct Motion {
  V largest = V(0), fastest = V(0);  ///< squared [m^2], [m^2/step^2]
  V finite = V(0);                   ///< 0, or NaN once a displacement is not finite
};

template <class V>
[[nodiscard]] Motion<V> motion_of(const std::vector<GrainLanes<V>>& grains) {
  Motion<V> m;
  for (const GrainLanes<V>& g : grains) {
    const V squared = fused(g.u_x, g.u_x, g.u_y * g.u_y);
    m.largest = larger(m.largest, squared);
    m.fastest = larger(m.fastest, fused(g.w_x, g.w_x, g.w_y * g.w_y));
    m.finite = fused(squared, V(0), m.finite);
  }
  return m;
}

/// The motion of an RVE whose grains stand in all lanes.
template <class One, class V>
[[nodiscard]] Motion<One> over_all_lanes(const Motion<V>& wide) {
  Motion<One> m;
  for (std::size_t l = 0; l < static_cast<std::size_t>(lane_count<V>); ++l) {
    m.largest = larger(m.largest, One(wide.largest[l]));
    m.fastest = larger(m.fastest, One(wide.fastest[l]));
    m.finite = m.finite + One(wide.finite[l]);
  }
  return m;
}

/// The motion of a group, wherever its grains are.
template <class Run, class V = typename Run::Value>
[[nodiscard]] Motion<V> motion_of_group(const Run& run) {
  if constexpr (Run::is_spread) {
    if (run.spread.holds()) return over_all_lanes<V>(motion_of(run.spread.grains()));
  }
  return motion_of(run.group.grains);
}

/// Makes the lane's current configuration its reference; histories are kept.
template <class Run>
void rebase(Run& run, std::size_t l) {
  auto& list = run.lists[l];
  auto& lane = run.lanes[l];
  run.kept_keys.clear();
  run.kept_histories.clear();
  for (const auto& p : list.pairs) {
    if (std::all_of(p.history.begin(), p.history.end(), [](auto number) { return number == 0; })) continue;
    run.kept_keys.push_back(p.key);
    run.kept_histories.insert(run.kept_histories.end(), p.history.begin(), p.history.end());
  }
  move_positions(run, l, list.position);
  list.cell = current_cell(lane, list.cell);
  lane.f_minus_i = Mat2{};
  for (auto& g : run.group.grains) g.u_x[l] = g.u_y[l] = 0;
  if (!reduce_cell(run, list)) return discard(run, l, RveStatus::neighbour_overflow);
  find_candidates(list.position, run.packing->radii, Cell(list.cell), run.scales.skin, run.keys);
  list_pairs<typename Run::Law>(list, run.packing->radii, run.scales.skin, run.keys,
                                {run.kept_keys, run.kept_histories.data()});
  list.rebased = true;
}

/// Renews the lists of the stale lanes, and the union of all lists.
template <class Run>
VOUSSOIR_OWN_SYMBOL void rebuild(Run& run, const std::array<bool, Run::width>& stale) {
  gather_spread(run);
  for (std::size_t l = 0; l < Run::width; ++l) {
    if (run.lanes[l].rve < 0 || (stale[l] && !run.lanes[l].running)) continue;  // empty, or just discarded
    gather_lane<typename Run::Law>(run.group, l, run.lists[l].pairs);
    if (stale[l]) rebase(run, l);
  }
  for (std::size_t l = 0; l < Run::width; ++l) round_motion(run.lanes[l], run.group.motion, l);
  run.builder.build(run.group, run.lists, *run.packing);
}

/// Whether the lane's list is to be renewed. A lane that is lost is discarded here, before its grains would be sorted
/// into bins.
template <class Run>
[[nodiscard]] bool is_stale(Run& run, std::size_t l, const Motion<typename Run::Value>& m, int step) {
  const double largest = std::sqrt(static_cast<double>(m.largest[l]));
  const double fastest = std::sqrt(static_cast<double>(m.fastest[l]));
  const ListState state = look_at_list(run.lanes[l], largest, fastest, m.finite[l] == 0, run.scales,
                                       run.settings.list_interval, step);
  if (state == ListState::not_finite) discard(run, l, RveStatus::not_finite);
  if (state == ListState::flown) discard(run, l, RveStatus::overlap_limit);
  return state != ListState::valid;
}

template <class Run>
void check_lists(Run& run, int step) {
  bool due = false;
  for (std::size_t l = 0; l < Run::width; ++l) {
    due = due || (run.lanes[l].running && step_of(run, l, step) >= run.lanes[l].next_list_check);
  }
  if (!due) return;
  const auto motion = motion_of_group(run);
  std::array<bool, Run::width> stale{};
  bool any = false;
  for (std::size_t l = 0; l < Run::width; ++l) {
    const auto& lane = run.lanes[l];
    const int own = step_of(run, l, step);
    if (!lane.running || own < lane.next_list_check) continue;
    stale[l] = is_stale(run, l, motion, own);
    any = any || stale[l];
  }
  if (!any) return;
  const Region region(run.regions, "lists");
  rebuild(run, stale);
}

}  // namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES
