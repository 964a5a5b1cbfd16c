#pragma once
/// A team lists the pairs of its RVE by trying all of them; its threads share the N (N - 1) / 2 distances. Rows come
/// out in ascending order without a sort.

#include "kernels/contact/pair_reference.hpp"
#include "kernels/teams/team_run.hpp"

namespace voussoir::kernels::teams {

/// Contacts with the history that a new list takes over, by ascending key.
template <class Keys, class Histories>
struct KeptContacts {
  const Keys& keys;            ///< pair_key
  const Histories& histories;  ///< (contact, k), as in RveStates
  int count;

  /// The place of the pair, or -1 where it is not kept.
  [[nodiscard]] KOKKOS_FUNCTION int find(std::uint32_t key) const {
    int first = 0, last = count;
    while (first < last) {
      const int middle = (first + last) / 2;
      if (keys(middle) < key) {
        first = middle + 1;
      } else {
        last = middle;
      }
    }
    return first < count && keys(first) == key ? first : -1;
  }
};

/// Calls meet(j) for all j > i within reach, ascending.
template <class Run, class Meet>
KOKKOS_FORCEINLINE_FUNCTION void meet_others(const Run& run, const Cell& cell, int i, const Meet& meet) {
  const double x = run.at.position(i, 0), y = run.at.position(i, 1), r = run.radius(i), skin = run.scales().skin;
  for (int j = i + 1; j < run.grains; ++j) {
    const double reach = r + run.radius(j) + skin;
    if (is_within(reach, run.at.position(j, 0) - x, run.at.position(j, 1) - y, cell)) meet(j);
  }
}

/// Sorts a few numbers in ascending order.
template <class Numbers>
KOKKOS_INLINE_FUNCTION void sort_few(const Numbers& numbers, int first, int last) {
  for (int k = first + 1; k < last; ++k) {
    const int moved = numbers(k);
    int to = k;
    for (; to > first && numbers(to - 1) > moved; --to) numbers(to) = numbers(to - 1);
    numbers(to) = moved;
  }
}

/// Where a grain's incoming pairs begin; they end at incoming_end(i).
template <class Run>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION int incoming_begin(const Run& run, int i) {
  return i == 0 ? 0 : run.at.incoming_end(i - 1);
}

/// Finds the rows, and every grain's incoming pairs in the order of the list. False where the list has no room for all
/// pairs.
template <class Run>
[[nodiscard]] KOKKOS_FUNCTION bool find_pairs(const Run& run, const Cell& cell) {
  const auto& at = run.at;
  const int n = run.grains;
  each(run, n, [&](int i) {
    int own = 0;
    meet_others(run, cell, i, [&](int) { ++own; });
    at.row(i) = own;
    at.incoming_end(i) = 0;
  });
  const int pairs = sums_before(run, n, at.row);
  alone(run, [&] { at.row(n) = pairs; });
  if (pairs > at.capacity(n)) return false;
  each(run, n, [&](int i) {
    int p = at.row(i);
    meet_others(run, cell, i, [&](int j) {
      at.first(p) = i;
      at.shapes(p).other = j;
      Kokkos::atomic_inc(&at.incoming_end(j));
      ++p;
    });
  });
  static_cast<void>(sums_before(run, n, at.incoming_end));
  each(run, pairs, [&](int p) { at.incoming(Kokkos::atomic_fetch_inc(&at.incoming_end(at.shapes(p).other))) = p; });
  each(run, n, [&](int i) { sort_few(at.incoming, incoming_begin(run, i), at.incoming_end(i)); });
  return true;
}

/// Makes the list at the RVE's positions; branches and gaps are computed in double and rounded once. A kept contact
/// that is no candidate has opened by more than the skin and is dropped. False where there is no room.
template <class Run, class Kept>
[[nodiscard]] KOKKOS_FUNCTION bool list_pairs(const Run& run, const Kept& kept) {
  using Law = typename Run::Law;
  using V = typename Run::V;
  using real = typename Run::real;
  const auto& at = run.at;
  const Cell cell(run.shared().cell);
  if (!find_pairs(run, cell)) return false;
  each(run, run.listed(), [&](int p) {
    const int i = at.first(p), j = at.shapes(p).other;
    at.shapes(p) = pair_shape<Law>(j, run.material(i), run.radius(i), run.material(j), run.radius(j));
    const PairReference reference = pair_reference(at.position(j, 0) - at.position(i, 0),
                                                   at.position(j, 1) - at.position(i, 1), run.radius(i) + run.radius(j),
                                                   cell);
    const int k = kept.find(pair_key(i, j));
    PairLanes<Law> pair{V(static_cast<real>(reference.branch_x)), V(static_cast<real>(reference.branch_y)),
                        V(static_cast<real>(reference.gap)), no_history<Law>()};
    if (k >= 0) read_history<Law>(pair.history, 0, [&](int q) { return kept.histories(k, q); });
    at.pairs(p) = pair;
    at.actions(p) = {V(0), V(0), V(0), V(0)};
    at.branches(p) = {V(0), V(0), V(0)};
  });
  return true;
}

}  // namespace voussoir::kernels::teams
