#pragma once
/// The end of a group: stress, tangent and report of each lane, and its trial state.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>

#include "kernels/contact/resting_pair.hpp"
#include "kernels/course/rve_report.hpp"
#include "kernels/lanes/rebase.hpp"
#include "kernels/lanes/tangent.hpp"

namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES {

/// Sums over the contacts of all lanes at rest; histories are limited by the caps of the final positions.
template <class Law, class V = typename Law::Value>
Homogenised<V> homogenise(GroupState<Law>& group) {
  Homogenised<V> out;
  const GrainLanes<V>* const grains = group.grains.data();
  for (std::size_t i = 0; i < static_cast<std::size_t>(group.n_grains); ++i) {
    const V radius(group.shapes[i].radius);
    for (auto p = static_cast<std::size_t>(group.row[i]); p < static_cast<std::size_t>(group.row[i + 1]); ++p) {
      PairShape<Law>& shape = group.pair_shapes[p];
      const GrainLanes<V>& gj = grains[shape.other];
      const PairGeometry<V> at = geometry_of(group.pairs[p], group.motion, gj.u_x - grains[i].u_x,
                                             gj.u_y - grains[i].u_y);
      add_pair(out, rest(group.pairs[p], shape, at, group.motion, radius), at);
    }
  }
  return out;
}

/// 0 in lanes in which all grains' motions are finite, NaN in the others.
template <class Law, class V = typename Law::Value>
[[nodiscard]] V finite_or_nan(const GroupState<Law>& group) {
  V all(0);
  for (const GrainLanes<V>& g : group.grains) all = fused(g.u_x + g.u_y + g.rotation, V(0), all);
  return all;
}

/// Where a lane's contacts go.
struct ContactPlace {
  std::uint32_t* keys = nullptr;
  double* histories = nullptr;
  std::ptrdiff_t count = 0;  ///< of those stored so far
};

/// Stores the contacts at the final positions with their histories, for the lanes that are `stored`. Half of the lanes
/// touch in a pair, and it cannot be foreseen which ones; so each lane writes, and where the pair does not touch, what
/// it writes goes to a spare place.
template <class Run>
void store_contacts(const Run& run, const std::array<bool, Run::width>& stored) {
  using Law = typename Run::Law;
  using V = typename Run::Value;
  constexpr auto numbers = static_cast<std::ptrdiff_t>(history_size<Law>);
  const RveStates& to = run.batch->trial;
  const auto rve_of = [&run](std::size_t l) { return static_cast<std::size_t>(run.lanes[l].rve); };
  std::array<ContactPlace, Run::width> place{};
  std::uint32_t spare_key = 0;
  std::array<double, static_cast<std::size_t>(numbers) + 1> spare_history{};
  unsigned wanted = 0;
  for (std::size_t l = 0; l < Run::width; ++l) {
    if (!stored[l]) continue;
    wanted |= 1U << l;
    place[l] = {&to.contact_key(rve_of(l), 0), to.histories_of(rve_of(l)), 0};
  }
  for (std::size_t i = 0; i < run.group.grains.size(); ++i) {
    const auto& gi = run.group.grains[i];
    for (auto p = static_cast<std::size_t>(run.group.row[i]); p < static_cast<std::size_t>(run.group.row[i + 1]); ++p) {
      const int j = run.group.pair_shapes[p].other;
      const auto& gj = run.group.grains[static_cast<std::size_t>(j)];
      const auto& pair = run.group.pairs[p];
      const auto at = geometry_of(pair, run.group.motion, gj.u_x - gi.u_x, gj.u_y - gi.u_y);
      const unsigned touching = bits_of(at.gap < V(0)) & wanted;
      if (touching == 0) continue;
      const std::uint32_t key = pair_key(static_cast<int>(i), j);
      for (std::size_t l = 0; l < Run::width; ++l) {
        const std::ptrdiff_t touches = (touching >> l) & 1U;
        ContactPlace& at_lane = place[l];
        *(touches != 0 ? at_lane.keys + at_lane.count : &spare_key) = key;
        double* const history = touches != 0 ? at_lane.histories + numbers * at_lane.count : spare_history.data();
        write_history<Law>(pair.history, l,
                           [history](int k, const auto& number) { history[k] = static_cast<double>(number); });
        at_lane.count += touches;
      }
    }
  }
  for (std::size_t l = 0; l < Run::width; ++l) {
    if (stored[l]) to.contact_count(rve_of(l)) = static_cast<int>(place[l].count);
  }
}

/// Stores the lane's final configuration as the RVE's trial state, but for its contacts. False where they have no room
/// or the cell has become too narrow.
template <class Run>
[[nodiscard]] bool store(Run& run, std::size_t l, const RveReport& report) {
  const auto rve = static_cast<std::size_t>(run.lanes[l].rve);
  auto& list = run.lists[l];
  RveStates& to = run.batch->trial;
  move_positions(run, l, list.position);
  list.cell = current_cell(run.lanes[l], list.cell);
  if (report.contacts > to.contact_capacity() || !reduce_cell(run, list)) return false;
  const double h[4] = {list.cell.xx, list.cell.xy, list.cell.yx, list.cell.yy};
  std::copy_n(h, 4, &to.cell(rve, 0));
  std::copy(list.position.begin(), list.position.end(), &to.position(rve, 0, 0));
  for (std::size_t i = 0; i < run.group.grains.size(); ++i) {
    to.rotation(rve, i) = run.batch->committed.rotation(rve, i) + run.lanes[l].rotation +
                          static_cast<double>(run.group.grains[i].rotation[l]);
  }
  return true;
}

/// Notes by how much grains may have come nearer in a lane, which decides how long its candidates hold.
template <class Run>
void note_motion(Run& run, std::size_t l, const Motion<typename Run::Value>& motion) {
  if (run.lists[l].rebased) return;  // the motion before the rebase is not known any more
  CandidateCache& cache = run.batch->candidates;
  const auto rve = static_cast<std::size_t>(run.lanes[l].rve);
  const double farthest = run.scales.reach + cache.skin[rve] - run.scales.skin;
  cache.spending[rve] = cache.spent[rve] + 2.0 * std::sqrt(static_cast<double>(motion.largest[l])) +
                        run.lanes[l].f_minus_i.norm() * farthest;
}

/// Writes the group's reports and trial states. An RVE that failed keeps its committed state as trial state.
template <class Run>
VOUSSOIR_OWN_SYMBOL void finish(Run& run, std::span<RveReport> reports) {
  const Region region(run.regions, "finish");
  for (std::size_t l = 0; l < Run::width; ++l) round_motion(run.lanes[l], run.group.motion, l);
  const auto sums = homogenise(run.group);
  const auto finite = finite_or_nan(run.group);
  std::array<RveReport, Run::width> answers;
  for (std::size_t l = 0; l < Run::width; ++l) {
    const auto& lane = run.lanes[l];
    RveReport& report = answers[l];
    begin_report(lane, report);
    if (lane.rve >= 0 && !is_failure(report.status)) {
      fill_report(lane, sums, l, volume_of(run, l), finite[l] == 0, run.scales, run.settings, report);
    }
  }
  if (run.settings.tangent != TangentKind::contact) replace_tangents(run, answers);
  std::array<bool, Run::width> stored{};
  const auto motion = motion_of_group(run);
  for (std::size_t l = 0; l < Run::width; ++l) {
    if (run.lanes[l].rve < 0) continue;
    RveReport& report = answers[l];
    give_up_crushed(report, run.batch->trial.contact_capacity());
    if (!is_failure(report.status) && !store(run, l, report)) report.status = RveStatus::neighbour_overflow;
    const auto rve = static_cast<std::size_t>(run.lanes[l].rve);
    stored[l] = !is_failure(report.status);
    if (stored[l]) note_motion(run, l, motion);
    if (!stored[l]) copy_state(run.batch->committed, run.batch->trial, rve, run.group.grains.size());
    reports[rve] = report;
  }
  store_contacts(run, stored);
}

}  // namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES
