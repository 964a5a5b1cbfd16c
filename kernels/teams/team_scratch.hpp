#pragma once
/// Working state of one RVE in its team's scratch. A GPU's fast memory (level 0) holds the grains, which every pair
/// reads, if they fit. The list and the arrays of a rebase are in level 1, of which there is one per running team, not
/// one per RVE.

#include <Kokkos_Core.hpp>

#include "kernels/contact/resting_pair.hpp"
#include "kernels/course/rve_course.hpp"

namespace voussoir::kernels::teams {

/// Pairs per grain for which a team's list has room. Discs have at most 3 contacts each, but a list with a skin holds
/// more pairs. An RVE that needs more room ends as `neighbour_overflow`.
inline constexpr int listed_per_grain = 8;

/// The data that all threads of a team share.
template <class V, class Drive>
struct TeamShared {
  RveCourse<Drive> course;
  CellMotion<V> motion;
  SweepSums<V> sums;
  Homogenised<V> rest;  ///< at the end
  Mat2 cell;            ///< at the last rebase
  ListState list;       ///< result of the last look
};

/// A pair's current branch, kept by measuring steps.
template <class V>
struct PairBranch {
  V x, y, overlap;  ///< b [m]; e = -g/R^2
};

/// Force on a grain, kept by measuring steps [N].
template <class V>
struct GrainForce {
  V x, y;
};

template <class V>
struct PairSprings {
  SpringTerms<V> normal, tangential;
  V weight;  ///< 1 where the pair touches
};

template <class Law, class Drive, class Space>
struct TeamScratch {
  using V = typename Law::Value;
  using Memory = typename Space::scratch_memory_space;
  template <class T>
  using Array = Kokkos::View<T, Kokkos::LayoutRight, Memory, Kokkos::MemoryUnmanaged>;
  using Shared = Array<TeamShared<V, Drive>*>;
  using Grains = Array<GrainLanes<V>*>;
  using Positions = Array<double* [2]>;
  using Counts = Array<int*>;
  using Pairs = Array<PairLanes<Law>*>;
  using Shapes = Array<PairShape<Law>*>;
  using Actions = Array<PairAction<V>*>;
  using Branches = Array<PairBranch<V>*>;
  using Forces = Array<GrainForce<V>*>;
  using Springs = Array<PairSprings<V>*>;
  using Keys = Array<std::uint32_t*>;
  using Histories = Array<double**>;

  Shared shared;  ///< one
  Grains grains;
  Positions position;   ///< at the last rebase [m]
  Counts row;           ///< pairs of grain i: row(i) .. row(i + 1)
  Counts first;         ///< i of a pair; j is shapes(p).other
  Counts incoming_end;  ///< pairs (h, i), h < i: incoming(incoming_end(i - 1) .. incoming_end(i)), ascending
  Counts incoming;
  Pairs pairs;
  Shapes shapes;
  Actions actions;  ///< of the step that runs
  Branches branches;
  Forces forces;
  Springs springs;  ///< at the end
  Keys kept_key;    ///< of a rebase: contacts with history
  Histories kept_history;

  template <class Member>
  KOKKOS_FUNCTION TeamScratch(const Member& team, int hot_level, int n)
      : shared(team.team_scratch(hot_level), 1),
        grains(team.team_scratch(hot_level), n),
        position(team.team_scratch(1), n),
        row(team.team_scratch(1), n + 1),
        first(team.team_scratch(1), capacity(n)),
        incoming_end(team.team_scratch(1), n),
        incoming(team.team_scratch(1), capacity(n)),
        pairs(team.team_scratch(1), capacity(n)),
        shapes(team.team_scratch(1), capacity(n)),
        actions(team.team_scratch(1), capacity(n)),
        branches(team.team_scratch(1), capacity(n)),
        forces(team.team_scratch(1), n),
        springs(team.team_scratch(1), capacity(n)),
        kept_key(team.team_scratch(1), capacity(n)),
        kept_history(team.team_scratch(1), capacity(n), history_size<Law>) {}

  static KOKKOS_FUNCTION int capacity(int n) { return listed_per_grain * n; }

  /// Bytes of the numbers that every step reads of all grains.
  static std::size_t hot_bytes(int n) { return Shared::shmem_size(1) + Grains::shmem_size(n); }

  static std::size_t cold_bytes(int n) {
    const int pairs = capacity(n);
    return Positions::shmem_size(n) + Counts::shmem_size(n + 1) + Counts::shmem_size(n) + Forces::shmem_size(n) +
           2 * Counts::shmem_size(pairs) + Pairs::shmem_size(pairs) + Shapes::shmem_size(pairs) +
           Actions::shmem_size(pairs) + Branches::shmem_size(pairs) + Springs::shmem_size(pairs) +
           Keys::shmem_size(pairs) + Histories::shmem_size(pairs, history_size<Law>);
  }
};

}  // namespace voussoir::kernels::teams
