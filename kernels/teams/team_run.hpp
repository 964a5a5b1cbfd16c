#pragma once
/// One team at work on one RVE: where its numbers are, and the functions by which its threads share a loop. Each of
/// these functions ends in a barrier.
///
/// Results do not depend on the number of threads: a loop's body writes only the numbers of its own index, maxima and
/// counts do not depend on an order, and sums of real numbers are taken by one thread each, in the order of the list.

#include "kernels/teams/team_batch.hpp"
#include "kernels/teams/team_scratch.hpp"

namespace voussoir::kernels::teams {

template <class LawType, class DriveType, class SpaceType, class MemberType>
struct TeamRun {
  using Law = LawType;
  using V = typename Law::Value;
  using real = real_of<V>;
  using Drive = DriveType;
  using Space = SpaceType;

  const MemberType& member;
  const TeamBatch<real, Drive, Space>& batch;
  const EngineSettings& settings;
  int rve;
  int packing;
  int grains;
  TeamScratch<Law, Drive, Space> at;

  KOKKOS_FUNCTION TeamRun(const MemberType& team, const TeamBatch<real, Drive, Space>& all, const EngineSettings& s,
                          int hot_level)
      : member(team),
        batch(all),
        settings(s),
        rve(all.order(team.league_rank())),
        packing(all.packing_of(rve)),
        grains(all.packings.scales(packing).grains),
        at(team, hot_level, all.most_grains) {}

  [[nodiscard]] KOKKOS_FUNCTION const RunScales& scales() const { return batch.packings.scales(packing); }
  [[nodiscard]] KOKKOS_FUNCTION TeamShared<V, Drive>& shared() const { return at.shared(0); }
  [[nodiscard]] KOKKOS_FUNCTION RveCourse<Drive>& course() const { return at.shared(0).course; }
  [[nodiscard]] KOKKOS_FUNCTION double radius(int i) const { return batch.packings.radii(packing, i); }
  [[nodiscard]] KOKKOS_FUNCTION const GrainShape<real>& shape(int i) const { return batch.packings.shapes(packing, i); }
  [[nodiscard]] KOKKOS_FUNCTION const GrainMaterial& material(int i) const {
    return batch.packings.materials(packing, i);
  }
  /// Pairs in the list.
  [[nodiscard]] KOKKOS_FUNCTION int listed() const { return at.row(grains); }
};

/// Calls body(i) for i = 0 .. n - 1.
template <class Run, class Body>
KOKKOS_FORCEINLINE_FUNCTION void each(const Run& run, int n, const Body& body) {
  Kokkos::parallel_for(Kokkos::TeamThreadRange(run.member, n), body);
  run.member.team_barrier();
}

/// Calls body() by one thread.
template <class Run, class Body>
KOKKOS_FORCEINLINE_FUNCTION void alone(const Run& run, const Body& body) {
  Kokkos::single(Kokkos::PerTeam(run.member), body);
  run.member.team_barrier();
}

/// Largest of body(i), at least 0; a NaN counts as 0.
template <class real, class Run, class Body>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION real largest(const Run& run, int n, const Body& body) {
  real out(0);
  Kokkos::parallel_reduce(
      Kokkos::TeamThreadRange(run.member, n),
      [&](int i, real& most) {
        const real x = body(i);
        most = most < x ? x : most;
      },
      Kokkos::Max<real>(out));
  run.member.team_barrier();
  return out < real(0) ? real(0) : out;
}

/// The number of i for which body(i) is true.
template <class Run, class Body>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION int count(const Run& run, int n, const Body& body) {
  int out = 0;
  Kokkos::parallel_reduce(
      Kokkos::TeamThreadRange(run.member, n), [&](int i, int& sum) { sum += body(i) ? 1 : 0; }, Kokkos::Sum<int>(out));
  run.member.team_barrier();
  return out;
}

/// Calls place(i, number of k < i with holds(k)) for every i with holds(i). @returns the number of such i
template <class Run, class Holds, class Place>
KOKKOS_FORCEINLINE_FUNCTION int pack(const Run& run, int n, const Holds& holds, const Place& place) {
  int out = 0;
  Kokkos::parallel_scan(
      Kokkos::TeamThreadRange(run.member, n),
      [&](int i, int& sum, bool final) {
        if (!holds(i)) return;
        if (final) place(i, sum);
        ++sum;
      },
      out);
  run.member.team_barrier();
  return out;
}

/// Replaces each of counts(0 .. n - 1) by the sum of the counts before it. @returns the sum of all
template <class Run, class Counts>
KOKKOS_FORCEINLINE_FUNCTION int sums_before(const Run& run, int n, const Counts& counts) {
  int out = 0;
  Kokkos::parallel_scan(
      Kokkos::TeamThreadRange(run.member, n),
      [&](int i, int& sum, bool final) {
        const int own = counts(i);
        if (final) counts(i) = sum;
        sum += own;
      },
      out);
  run.member.team_barrier();
  return out;
}

}  // namespace voussoir::kernels::teams
