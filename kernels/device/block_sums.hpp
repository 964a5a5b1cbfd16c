#pragma once
/// Sums and maxima over a block's threads, in a fixed order and in two stages: a thread for each group of threads, then
/// one thread for all groups.

#include "kernels/device/block_run.hpp"

namespace voussoir::kernels::device {

struct Add {
  KOKKOS_FORCEINLINE_FUNCTION double operator()(double a, double b) const { return a + b; }
};
/// A NaN on the right is not taken.
struct Largest {
  KOKKOS_FORCEINLINE_FUNCTION double operator()(double a, double b) const { return a < b ? b : a; }
};

/// Joins the numbers of all threads; thread 0 alone receives `all`. The action of pairs is overwritten, so that all
/// threads must have read it. Another barrier must follow before it is written again.
template <class Join, int count, class Run>
KOKKOS_FORCEINLINE_FUNCTION void reduce(const Run& run, const double (&own)[count], double (&all)[count]) {
  static_assert(count <= most_sums, "room_of_action makes room for fewer");
  const Join join;
  const int threads = run.block.threads(), thread = run.block.thread();
  const int groups = (threads + threads_of_group - 1) / threads_of_group;
  double* const numbers = reinterpret_cast<double*>(run.at.action);
  double* const of_groups = numbers + count * threads;
  for (int q = 0; q < count; ++q) numbers[q * threads + thread] = own[q];
  run.block.barrier();
  for (int g = thread; g < count * groups; g += threads) {
    const int first = g % groups * threads_of_group;
    const int last = first + threads_of_group < threads ? first + threads_of_group : threads;
    const double* const from = numbers + g / groups * threads;
    double sum = from[first];
    for (int k = first + 1; k < last; ++k) sum = join(sum, from[k]);
    of_groups[g] = sum;
  }
  run.block.barrier();
  if (thread != 0) return;
  for (int q = 0; q < count; ++q) {
    double sum = of_groups[q * groups];
    for (int g = 1; g < groups; ++g) sum = join(sum, of_groups[q * groups + g]);
    all[q] = sum;
  }
}

/// As reduce, and tells all threads.
template <class Join, int count, class Run>
KOKKOS_FORCEINLINE_FUNCTION void reduce_for_all(const Run& run, double (&numbers)[count]) {
  static_assert(count <= 4);
  double all[count] = {};
  reduce<Join>(run, numbers, all);
  alone(run, [&] {
    for (int q = 0; q < count; ++q) run.at.control->told[q] = all[q];
  });
  for (int q = 0; q < count; ++q) numbers[q] = run.at.control->told[q];
  run.block.barrier();
}

/// Replaces each of values[0 .. n - 1], which all threads must see, by the sum of the values before it. Returns the sum
/// of all, and ends in a barrier.
template <class Run>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION int sums_before(const Run& run, int* values, int n) {
  const int threads = run.block.threads(), thread = run.block.thread();
  const int groups = (threads + threads_of_group - 1) / threads_of_group;
  int* const of_threads = run.at.counts;
  int* const of_groups = of_threads + threads;
  const int chunk = (n + threads - 1) / threads;
  const int begin = chunk * thread < n ? chunk * thread : n;
  const int end = begin + chunk < n ? begin + chunk : n;
  int own = 0;
  for (int i = begin; i < end; ++i) own += values[i];
  of_threads[thread] = own;
  run.block.barrier();
  each(run, groups, [&](int g) {
    const int first = g * threads_of_group;
    int sum = 0;
    for (int k = first; k < first + threads_of_group && k < threads; ++k) sum += of_threads[k];
    of_groups[g] = sum;
  });
  run.block.barrier();
  const int group = thread / threads_of_group;
  int before = 0, all = 0;
  for (int g = 0; g < groups; ++g) {
    if (g < group) before += of_groups[g];
    all += of_groups[g];
  }
  for (int k = group * threads_of_group; k < thread; ++k) before += of_threads[k];
  for (int i = begin; i < end; ++i) {
    const int value = values[i];
    values[i] = before;
    before += value;
  }
  run.block.barrier();
  return all;
}

}  // namespace voussoir::kernels::device
