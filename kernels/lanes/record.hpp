#pragma once
/// The contact network of a lane in the middle of its run, for requests that record it along their path.

#include <vector>

#include "kernels/lanes/group_run.hpp"
#include "kernels/state/network.hpp"

namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES {

/// The contacts of lane `l`, whose cell and grains must be at the same step. They have normal forces only, since
/// tangential forces are not known before the sweep.
template <class Run>
[[nodiscard]] std::vector<NetworkContact> network_of(const Run& run, std::size_t l) {
  using Law = typename Run::Law;
  using V = typename Run::Value;
  const V zero(0);
  std::vector<NetworkContact> out;
  for (std::size_t i = 0; i < run.group.grains.size(); ++i) {
    const auto& gi = run.group.grains[i];
    for (auto p = static_cast<std::size_t>(run.group.row[i]); p < static_cast<std::size_t>(run.group.row[i + 1]); ++p) {
      const auto& shape = run.group.pair_shapes[p];
      const auto& gj = run.group.grains[static_cast<std::size_t>(shape.other)];
      const auto& pair = run.group.pairs[p];
      const auto at = geometry_of(pair, run.group.motion, gj.u_x - gi.u_x, gj.u_y - gi.u_y);
      if (!(at.gap[l] < 0)) continue;
      const PairDistance<V> distance = distance_of(at.gap, shape);
      typename Law::History history = pair.history;
      const auto force = Law(shape.law)({distance.overlap, distance.excess, zero, zero}, history);
      const V to_unit = distance.inverse_length;
      out.push_back({static_cast<int>(i), shape.other, static_cast<double>((at.branch_x * to_unit)[l]),
                     static_cast<double>((at.branch_y * to_unit)[l]),
                     static_cast<double>((force.normal_to_branch / to_unit)[l])});
    }
  }
  return out;
}

/// Gives each drive that records at this step the microstructure of its lane; rotations count from the request's start.
/// To be called before the sweep, where cell and grains are at the same step. Compiled out for drives that never
/// record.
template <class Run>
void record_microstructures(Run& run, int step) {
  if constexpr (Run::Drive::can_record) {
    for (std::size_t l = 0; l < Run::width; ++l) {
      auto& lane = run.lanes[l];
      if (!lane.running || !lane.drive.records(step_of(run, l, step))) continue;
      gather_spread(run);
      Microstructure m;
      for (const auto& g : run.group.grains) m.grain_rotation += static_cast<double>(g.rotation[l]);
      m.grain_rotation = lane.rotation + m.grain_rotation / run.group.n_grains;
      describe_network(network_of(run, l), run.group.n_grains, lane.drive.recorded_quantities(), m);
      lane.drive.record(m);
    }
  }
}

}  // namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES
