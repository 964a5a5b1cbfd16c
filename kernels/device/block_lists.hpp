#pragma once
/// Lists of a block's RVE: candidates from a grid of bins, and the list of those within the skin.
///
/// Candidates are found with a wider skin and stay in the device's memory from evaluation to evaluation, until grains
/// may have come nearer by the difference. The order of a list is that of its keys, whatever the threads do first.

#include "kernels/contact/pair_reference.hpp"
#include "kernels/device/block_sums.hpp"

namespace voussoir::kernels::device {

enum class Listing { done, too_many };

/// Contacts with the history that a new list takes over, by ascending key.
template <class Number>
struct KeptContacts {
  const std::uint32_t* key;
  const Number* history;  ///< (contact, k)
  int count;
};

/// The first of keys[0 .. count - 1], which ascend, that is not below `key`.
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION int lower_bound(const std::uint32_t* keys, int count, std::uint32_t key) {
  int first = 0, last = count;
  while (first < last) {
    const int middle = (first + last) / 2;
    if (keys[middle] < key) {
      first = middle + 1;
    } else {
      last = middle;
    }
  }
  return first;
}

/// Sorts a few numbers in ascending order.
template <class Number>
KOKKOS_FORCEINLINE_FUNCTION void sort_few(Number* numbers, int count) {
  for (int k = 1; k < count; ++k) {
    const Number moved = numbers[k];
    int to = k;
    for (; to > 0 && numbers[to - 1] > moved; --to) numbers[to] = numbers[to - 1];
    numbers[to] = moved;
  }
}

/// Bins over the cell, in its own (sheared) coordinates. Grains within reach of each other are in the same bin or in
/// neighbouring ones.
struct Bins {
  Cell cell;
  int columns, rows;

  /// @param reach of the longest candidate [m]; @param most bins
  KOKKOS_FORCEINLINE_FUNCTION Bins(const Mat2& h, double reach, int most) : cell(h) {
    columns = fitting(cell.height(0), reach, most);
    rows = fitting(cell.height(1), reach, most / columns);
  }
  [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION static int fitting(double height, double reach, int most) {
    const double fit = std::floor(height / reach);
    return fit < 1 ? 1 : (fit > most ? (most < 1 ? 1 : most) : static_cast<int>(fit));
  }
  [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION int count() const { return columns * rows; }
  [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION static int place(double fraction, int bins) {
    const int at = static_cast<int>((fraction - std::floor(fraction)) * bins);
    return at < bins ? at : bins - 1;
  }
  [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION int column_of(double x, double y) const {
    return place(cell.inverse.xx * x + cell.inverse.xy * y, columns);
  }
  [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION int row_of(double x, double y) const {
    return place(cell.inverse.yx * x + cell.inverse.yy * y, rows);
  }
  /// Calls visit(bin) once for each bin that may hold grains near a point of the given column and row.
  template <class Visit>
  KOKKOS_FORCEINLINE_FUNCTION void around(int column, int row, const Visit& visit) const {
    for (int b = rows > 2 ? -1 : 0; b < (rows > 1 ? 2 : 1); ++b) {
      const int r = (row + b + rows) % rows;
      for (int a = columns > 2 ? -1 : 0; a < (columns > 1 ? 2 : 1); ++a)
        visit(r * columns + (column + a + columns) % columns);
    }
  }
};

/// The scratch of find_candidates, in the memory of the pairs' actions (room_of_bins).
struct BinScratch {
  int *begin, *next, *row;  ///< of a bin; where it is filled next; candidates of the grains before
  int* grain;               ///< bin by bin

  template <class Run>
  KOKKOS_FORCEINLINE_FUNCTION explicit BinScratch(const Run& run)
      : begin(reinterpret_cast<int*>(run.at.action)),
        next(begin + run.grains + 1),
        row(next + run.grains),
        grain(row + run.grains) {}
};

/// Sorts the grains into bins.
template <class Run>
KOKKOS_FORCEINLINE_FUNCTION void fill_bins(const Run& run, const Bins& bins, const BinScratch& scratch,
                                           const double* position) {
  const auto bin_of = [&](int i) {
    const double x = position[2 * i], y = position[2 * i + 1];
    return bins.row_of(x, y) * bins.columns + bins.column_of(x, y);
  };
  each(run, bins.count(), [&](int b) { scratch.begin[b] = 0; });
  run.block.barrier();
  each(run, run.grains, [&](int i) { Kokkos::atomic_inc(&scratch.begin[bin_of(i)]); });
  run.block.barrier();
  static_cast<void>(sums_before(run, scratch.begin, bins.count()));
  each(run, bins.count(), [&](int b) { scratch.next[b] = scratch.begin[b]; });
  if (run.block.thread() == 0) scratch.begin[bins.count()] = run.grains;
  run.block.barrier();
  each(run, run.grains, [&](int i) { scratch.grain[Kokkos::atomic_fetch_add(&scratch.next[bin_of(i)], 1)] = i; });
  run.block.barrier();
}

/// Candidates for which both the device's memory and the block's scratch have room.
template <class Run>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION int most_candidates(const Run& run) {
  const int in_block = candidates_per_pair * run.capacity, in_memory = run.batch.candidates.capacity;
  return in_block < in_memory ? in_block : in_memory;
}

/// Finds the candidates of the RVE at its positions. @param position in the trial state; @param skin [m]
template <class Run>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION Listing find_candidates(const Run& run, const double* position, double skin) {
  const DeviceCandidates& to = run.batch.candidates;
  std::uint32_t* const keys = to.key +
                              static_cast<std::size_t>(run.candidates()) * static_cast<std::size_t>(to.capacity);
  const Bins bins(run.at.control->cell, 2.0 * run.scales().largest_radius + skin, run.grains);
  const BinScratch scratch(run);
  fill_bins(run, bins, scratch, position);
  const auto meet = [&](int i, const auto& with) {
    const double x = position[2 * i], y = position[2 * i + 1], r = run.radius(i);
    bins.around(bins.column_of(x, y), bins.row_of(x, y), [&](int bin) {
      for (int q = scratch.begin[bin]; q < scratch.begin[bin + 1]; ++q) {
        const int j = scratch.grain[q];
        if (j <= i) continue;
        if (is_within(r + run.radius(j) + skin, position[2 * j] - x, position[2 * j + 1] - y, bins.cell)) with(j);
      }
    });
  };
  each(run, run.grains, [&](int i) {
    int own = 0;
    meet(i, [&](int) { ++own; });
    scratch.row[i] = own;
  });
  run.block.barrier();
  const int all = sums_before(run, scratch.row, run.grains);
  if (all > most_candidates(run)) return Listing::too_many;
  each(run, run.grains, [&](int i) {
    std::uint32_t* const row = keys + scratch.row[i];
    int own = 0;
    meet(i, [&](int j) { row[own++] = pair_key(i, j); });
    sort_few(row, own);
  });
  alone(run, [&] { to.count[run.candidates()] = all; });
  return Listing::done;
}

/// Makes sure that the candidates hold for the RVE's committed state.
template <class Run>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION Listing ensure_candidates(const Run& run, const double* position) {
  const DeviceCandidates& to = run.batch.candidates;
  const double wide = candidate_skin * run.scales().skin;
  // Without candidates, what was spent is not known.
  const bool hold = !to.of_blocks && to.skin[run.candidates()] >= 0 &&
                    to.spent[run.candidates()] <= to.skin[run.candidates()] - run.scales().skin;
  run.block.barrier();
  if (hold) return Listing::done;
  if (find_candidates(run, position, wide) == Listing::too_many) return Listing::too_many;
  alone(run, [&] {
    to.skin[run.candidates()] = wide;
    to.spent[run.candidates()] = 0;
  });
  return Listing::done;
}

/// Lists the candidates within the skin.
template <class Run>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION Listing choose_pairs(Run& run, const double* position) {
  const DeviceCandidates& from = run.batch.candidates;
  const std::uint32_t* const keys = from.key + static_cast<std::size_t>(run.candidates()) *
                                                   static_cast<std::size_t>(from.capacity);
  const int candidates = from.count[run.candidates()];
  if (candidates > most_candidates(run)) return Listing::too_many;
  static_assert(candidates_per_pair * sizeof(int) <= sizeof(Four<typename Run::real>), "a flag for each candidate");
  int* const flag = reinterpret_cast<int*>(run.at.action);
  std::uint32_t* const chosen = run.at.keys;
  const Cell cell(run.at.control->cell);
  const double skin = run.scales().skin;
  const auto is_listed = [&](std::uint32_t key) {
    const int i = first_of(key), j = second_of(key);
    const double sum = run.radius(i) + run.radius(j);
    const double dx = position[2 * j] - position[2 * i], dy = position[2 * j + 1] - position[2 * i + 1];
    return pair_reference(dx, dy, sum, cell).gap < skin * (2.0 * sum + skin);
  };
  each(run, candidates, [&](int c) { flag[c] = is_listed(keys[c]) ? 1 : 0; });
  run.block.barrier();
  const int all = sums_before(run, flag, candidates);
  if (all > run.capacity) return Listing::too_many;
  run.listed = all;
  each(run, candidates, [&](int c) {
    const int next = c + 1 < candidates ? flag[c + 1] : all;
    if (next > flag[c]) chosen[flag[c]] = keys[c];
  });
  run.block.barrier();
  each(run, run.grains, [&](int i) { flag[i] = 0; });
  run.block.barrier();
  return Listing::done;
}

/// Lists for each grain its pairs, in the order of the list.
template <class Run>
KOKKOS_FORCEINLINE_FUNCTION void list_entries(Run& run) {
  using Index = typename Run::Index;
  int* const next = reinterpret_cast<int*>(run.at.action);
  each_pair(run, [&](int p) {
    Kokkos::atomic_inc(&next[first_of(run.at.keys[p])]);
    Kokkos::atomic_inc(&next[second_of(run.at.keys[p])]);
  });
  run.block.barrier();
  static_cast<void>(sums_before(run, next, run.grains));
  each(run, run.grains, [&](int i) { run.at.row[i] = static_cast<Index>(next[i]); });
  if (run.block.thread() == 0) run.at.row[run.grains] = static_cast<Index>(2 * run.listed);
  run.block.barrier();
  each_pair(run, [&](int p) {
    const auto enter = [&](int grain, int entry) {
      run.at.entries[Kokkos::atomic_fetch_add(&next[grain], 1)] = static_cast<Index>(entry);
    };
    enter(first_of(run.at.keys[p]), 2 * p);
    enter(second_of(run.at.keys[p]), 2 * p + 1);
  });
  run.block.barrier();
  each(run, run.grains, [&](int i) {
    const int begin = static_cast<int>(run.at.row[i]);
    sort_few(run.at.entries + begin, static_cast<int>(run.at.row[i + 1]) - begin);
  });
  run.block.barrier();
}

/// Makes the list at the RVE's positions; branches and gaps are computed in double and rounded once. A kept contact
/// that is not listed has opened by more than the skin and is dropped.
template <class Run, class Number>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION Listing list_pairs(Run& run, const double* position,
                                                             const KeptContacts<Number>& kept) {
  using Law = typename Run::Law;
  using V = typename Run::V;
  using real = typename Run::real;
  if (choose_pairs(run, position) == Listing::too_many) return Listing::too_many;
  list_entries(run);
  const Cell cell(run.at.control->cell);
  each_pair(run, [&](int p) {
    const std::uint32_t key = run.at.keys[p];
    const int i = first_of(key), j = second_of(key);
    const PairReference at = pair_reference(position[2 * j] - position[2 * i],
                                            position[2 * j + 1] - position[2 * i + 1], run.radius(i) + run.radius(j),
                                            cell);
    PairLanes<Law> pair{V(static_cast<real>(at.branch_x)), V(static_cast<real>(at.branch_y)),
                        V(static_cast<real>(at.gap)), no_history<Law>()};
    const int c = lower_bound(kept.key, kept.count, key);
    if (c < kept.count && kept.key[c] == key)
      read_history<Law>(pair.history, 0, [&](int q) { return kept.history[c * history_size<Law> + q]; });
    set_pair(run, p, pair);
  });
  run.block.barrier();
  return Listing::done;
}

}  // namespace voussoir::kernels::device
