#pragma once
/// Looks: the sums over pairs and grains from which an RVE's stress and its unbalanced force follow. Their order is
/// fixed: 32 consecutive pairs (or grains) by one warp, then the partial sums by the first warp in double.

#include "tests/benchmark/gpu_step/instance.hpp"

namespace voussoir::gpu_step {

/// The sum of a warp's 32 pairs goes to its chunk. All threads of a warp call this together.
template <class Team, class Real>
VOUSSOIR_DEVICE void sum_pairs(const Team& team, const LookSums<Real>& sums, int chunk, const Stress<Real>& own) {
  const Stress<Real> all{team.warp_sum(own.xx), team.warp_sum(own.xy), team.warp_sum(own.yx), team.warp_sum(own.yy)};
  if (team.rank() % 32 == 0) sums.of_pairs[chunk] = all;
}
template <class Team, class Real>
VOUSSOIR_DEVICE void sum_grains(const Team& team, const LookSums<Real>& sums, int chunk, Real own) {
  const Real all = team.warp_sum(own);
  if (team.rank() % 32 == 0) sums.of_grains[chunk] = all;
}

/// The first warp sums the chunks, between two barriers of the caller.
template <class Team, class Real>
VOUSSOIR_DEVICE void sum_chunks(const Team& team, const LookSums<Real>& sums) {
  if (team.rank() >= 32) return;
  LookReport own{};
  for (int k = team.rank(); k < sums.pair_chunks; k += 32) {
    const Stress<Real>& part = sums.of_pairs[k];
    own.stress = {own.stress.xx + part.xx, own.stress.xy + part.xy, own.stress.yx + part.yx, own.stress.yy + part.yy};
  }
  for (int k = team.rank(); k < sums.grain_chunks; k += 32) own.force_squared += sums.of_grains[k];
  const LookReport all{{team.warp_sum(own.stress.xx), team.warp_sum(own.stress.xy), team.warp_sum(own.stress.yx),
                        team.warp_sum(own.stress.yy)},
                       team.warp_sum(own.force_squared)};
  if (team.rank() == 0) *sums.report = all;
}

/// A look between the pairs' part of a step and the grains' part, from shared memory and the list in global memory
/// alone. This function is called, and it finds its arrays anew, so that the step keeps all of its registers. Its sums
/// have the bits of a look inside a step. @param which of the two motions
template <class Instance, class Team>
VOUSSOIR_DEVICE_CALL void look_from_list(const Team team, const StepArguments<typename Instance::Real>& a, int which) {
  using Real = typename Instance::Real;
  constexpr int threads = Team::threads;
  Carver carver(team.shared());
  const StepMemory<Real> m = carve_step<Instance>(carver, a.grains, a.lists.capacity);
  const PairLists<Real>& lists = a.lists;
  const auto first = static_cast<std::size_t>(team.rve()) * static_cast<std::size_t>(lists.capacity);
  const auto row_first = static_cast<std::size_t>(team.rve()) * static_cast<std::size_t>(a.grains + 1);
  const int pairs = lists.pair_count[team.rve()], rank = team.rank();
  for (int k = 0; k < Instance::pair_slots; ++k) {
    const int p = k * threads + rank;
    Stress<Real> own{0, 0, 0, 0};
    if (p < pairs) {
      const std::size_t at = first + static_cast<std::size_t>(p);
      const std::uint32_t key = lists.grains[at];
      const Real bx = lists.branch_x[at], by = lists.branch_y[at];
      const Two<Real> d = branch_change(m.s.grain[key >> 16], m.s.grain[key & 0xffffU], bx, by, m.motion[which]);
      own = stress_of(m.s.action[p], bx + d.x, by + d.y);
    }
    sum_pairs(team, m.sums, k * (threads / 32) + rank / 32, own);
  }
  const std::uint16_t *const row = lists.row + row_first, *const incoming_row = lists.incoming_row + row_first;
  for (int g = 0; g < Instance::grain_slots; ++g) {
    const int i = g * threads + rank;
    Real own = 0;
    if (i < a.grains) {
      Load<Real> load;
      for (int k = incoming_row[i]; k < incoming_row[i + 1]; ++k) {
        load.add(m.s.action[lists.incoming[first + static_cast<std::size_t>(k)]], true);
      }
      for (int p = row[i]; p < row[i + 1]; ++p) load.add(m.s.action[p], false);
      own = fused(load.x, load.x, load.y * load.y);
    }
    sum_grains(team, m.sums, g * (threads / 32) + rank / 32, own);
  }
  team.barrier();
  sum_chunks(team, m.sums);
}

}  // namespace voussoir::gpu_step
