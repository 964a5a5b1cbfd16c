#pragma once
/// A group on its way from committed to trial states: its lanes, their lists and the working arrays. Each worker has
/// one such object and uses it for group after group.

#include <array>
#include <atomic>
#include <vector>

#include "kernels/contact/resting_pair.hpp"
#include "kernels/course/regions.hpp"
#include "kernels/course/rve_course.hpp"
#include "kernels/lanes/lists.hpp"
#include "kernels/lanes/spread_rve.hpp"
#include "kernels/tangents/loading_tangent.hpp"

namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES {

/// Members of a group by lane; -1 is an empty lane. All share one packing.
template <int width>
using GroupMembers = std::array<int, static_cast<std::size_t>(width)>;

/// What a group of many lanes has in place of a SpreadRve.
struct NotSpread {};

template <class LawType, class DriveType>
struct GroupRun {
  using Law = LawType;
  using Value = typename Law::Value;
  using V = Value;
  using Drive = DriveType;
  using real = real_of<V>;
  static constexpr std::size_t width = static_cast<std::size_t>(lane_count<V>);
  static constexpr bool is_spread = width == 1 && lane_count<WideLane<real>> > 1;

  RveBatch* batch = nullptr;
  const Packing* packing = nullptr;
  EngineSettings settings;
  RunScales scales;
  std::array<RveCourse<Drive>, width> lanes;
  std::array<LaneListOf<Law>, width> lists;
  std::array<int, width> steps_before;  ///< steps that a lane had made when the group began
  GroupState<Law> group;
  std::conditional_t<is_spread, SpreadRve<typename LawOver<Law, WideLane<real>>::type, Law>, NotSpread> spread;
  UnionBuilder<Law> builder;
  SpringSystem<V> springs;               ///< empty unless the static tangent is asked for
  StepSystem<V> step;                    ///< empty unless the loading tangent is asked for
  std::vector<std::uint32_t> keys;       ///< scratch of a rebase
  std::vector<std::uint32_t> kept_keys;  ///< scratch of a rebase: contacts with history, and its numbers
  std::vector<double> kept_histories;
  double tangent_seconds = 0;               ///< that the tangents of all groups so far have taken [s]
  const std::atomic<bool>* stop = nullptr;  ///< see stop_request.hpp
  Regions regions;
};

/// The step of a lane's own course at a step of its group.
template <class Run>
[[nodiscard]] int step_of(const Run& run, std::size_t l, int step) {
  return run.steps_before[l] + step;
}

/// Current volume of a lane's cell [m^3].
template <class Run>
[[nodiscard]] double volume_of(const Run& run, std::size_t l) {
  return current_cell(run.lanes[l], run.lists[l].cell).det() * run.scales.thickness;
}

/// Brings what an RVE that is spread over the lanes has become back into its group.
template <class Run>
void gather_spread(Run& run) {
  if constexpr (Run::is_spread) {
    if (run.spread.holds()) run.spread.give(run.group);
  }
}

/// Makes the lane stand still; no later step can change its numbers.
template <class Run>
void freeze(Run& run, std::size_t l, RveStatus status) {
  gather_spread(run);
  run.lanes[l].running = false;
  run.lanes[l].status = status;
  for (auto& g : run.group.grains) g.w_x[l] = g.w_y[l] = g.spin[l] = 0;
}

/// Gives the lane up and removes its numbers from the group.
template <class Run>
void discard(Run& run, std::size_t l, RveStatus status) {
  freeze(run, l, status);
  for (auto& g : run.group.grains) g.u_x[l] = g.u_y[l] = g.force_x[l] = g.force_y[l] = g.torque[l] = 0;
  run.lanes[l].f_minus_i = Mat2{};
  run.lists[l].pairs.clear();
}

/// Makes the cell as wide as its lattice allows: its shortest vectors replace those of a sheared cell, with the same
/// images. False when nearest images are not unique even then.
template <class Run>
[[nodiscard]] bool reduce_cell(const Run& run, LaneListOf<typename Run::Law>& list) {
  list.cell = reduced_lattice(list.cell);
  const Cell cell(list.cell);
  for (std::size_t i = 0; 2 * i < list.position.size(); ++i) cell.wrap(list.position[2 * i], list.position[2 * i + 1]);
  return wide_enough(cell, run.scales.largest_radius, run.scales.skin);
}

/// Replaces the reference positions X of a lane by its current ones, x = F X + u.
template <class Run>
void move_positions(const Run& run, std::size_t l, std::vector<double>& position) {
  const Mat2 f = plus_identity(run.lanes[l].f_minus_i);
  for (std::size_t i = 0; i < run.group.grains.size(); ++i) {
    const double px = position[2 * i], py = position[2 * i + 1];
    position[2 * i] = f.xx * px + f.xy * py + static_cast<double>(run.group.grains[i].u_x[l]);
    position[2 * i + 1] = f.yx * px + f.yy * py + static_cast<double>(run.group.grains[i].u_y[l]);
  }
}

}  // namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES
