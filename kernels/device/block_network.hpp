#pragma once
/// The sums of one committed state (state/network_sums.hpp), by one block: cell, mean rotation and contact network.
///
/// Everything is in double, and contacts and grains are added up one by one in the order of the host, so that the sums
/// have the host's bits however many threads a block has. Each grain's contacts are counted by one thread, which finds
/// them among those of all: there are no atomics.

#include "kernels/contact/committed_pair.hpp"
#include "kernels/contact/engine_law.hpp"
#include "kernels/device/block.hpp"
#include "kernels/device/block_batch.hpp"
#include "kernels/state/network_sums.hpp"

namespace voussoir::kernels::device {

/// What one call describes: all RVEs, RVE k by block k.
struct NetworkBatch {
  ExactPackings packings;
  DeviceStates states;
  const int* packing_of;  ///< by RVE
  ContactCounts* counts;  ///< (RVE, grain), scratch; only with `tallies`
  CommittedSums* out;     ///< by RVE
  NetworkThresholds thresholds;
  bool sums, tallies;  ///< the parts of NetworkSums that are wanted
};

/// Fast memory of a block.
struct NetworkMemory {
  enum : int { most_sums = 3 };

  double* terms;          ///< (sum, thread), what the items of a tile add
  double* sums;           ///< of contacts, then that of the rotations
  std::uint32_t* keys;    ///< by thread, of a tile's contacts
  ContactCounts* counts;  ///< by thread, what the contacts of a tile add to their grains
  GrainTally* tallies;    ///< by thread, of its grains
  std::size_t bytes;

  KOKKOS_FORCEINLINE_FUNCTION NetworkMemory(char* fast, int threads) {
    Carver carver(fast);
    terms = carver.take<double>(most_sums * threads);
    sums = carver.take<double>(most_sums + 1);
    keys = carver.take<std::uint32_t>(threads);
    counts = carver.take<ContactCounts>(threads);
    tallies = carver.take<GrainTally>(threads);
    bytes = carver.used();
  }
};

/// One block at work on one RVE.
template <class BlockType>
struct NetworkRun {
  BlockType block;
  const NetworkBatch& batch;
  int rve, packing, grains, contacts;
  DeviceState state;
  Cell cell;
  NetworkMemory at;

  KOKKOS_FORCEINLINE_FUNCTION NetworkRun(const BlockType& own, const NetworkBatch& all, int number)
      : block(own),
        batch(all),
        rve(number),
        packing(all.packing_of[number]),
        grains(all.packings.grains[packing]),
        state(state_of(all.states, all.states.committed_slot[number], number)),
        cell(Mat2{state.cell[0], state.cell[1], state.cell[2], state.cell[3]}),
        at(own.fast_memory(), own.threads()) {
    contacts = *state.contact_count;
  }

  [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION std::size_t grain(int i) const {
    return static_cast<std::size_t>(packing) * static_cast<std::size_t>(batch.packings.stride) +
           static_cast<std::size_t>(i);
  }
  [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION double radius(int i) const { return batch.packings.radii[grain(i)]; }
  [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION const GrainMaterial& material(int i) const {
    const int of_grain = batch.packings.class_of == nullptr ? 0 : batch.packings.class_of[grain(i)];
    return batch.packings.materials[packing * batch.packings.class_stride + of_grain];
  }
};

/// What contact c adds to the sums.
template <class Run>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION ContactSums sums_of(const Run& run, int c) {
  const int i = first_of(run.state.contact_key[c]), j = second_of(run.state.contact_key[c]);
  const double* const x = run.state.position;
  const double ri = run.radius(i), rj = run.radius(j);
  const auto line = centre_line(run.cell, x[2 * j] - x[2 * i], x[2 * j + 1] - x[2 * i + 1], ri, rj);
  const double force = normal_force_at_rest<NormalForceLaw>(run.material(i), ri, run.material(j), rj, line.overlap,
                                                            line.overlap_to_branch, line.length);
  return sums_of_contact(line.normal_x, line.normal_y, force);
}

/// Calls put(item) for each of n items, a tile of as many items as threads at a time, and then take(items of the tile)
/// by all threads. What put and take write is seen by all threads after each of them. There is one tile at least.
template <class Run, class Put, class Take>
KOKKOS_FORCEINLINE_FUNCTION void each_tile(const Run& run, int n, const Put& put, const Take& take) {
  const int threads = run.block.threads();
  int first = 0;
  do {
    const int item = first + run.block.thread();
    if (item < n) put(item);
    run.block.barrier();
    take(first, n - first < threads ? n - first : threads);
    run.block.barrier();
    first += threads;
  } while (first < n);
}

/// Adds the numbers of n items up, in their order, for all threads. @param terms (item, count numbers) writes what an
/// item adds
template <int count, class Run, class Terms>
KOKKOS_FORCEINLINE_FUNCTION void sum_in_order(const Run& run, int n, double* sums, const Terms& terms) {
  static_assert(count <= NetworkMemory::most_sums);
  const int threads = run.block.threads(), thread = run.block.thread();
  each_tile(
      run, n,
      [&](int item) {
        double own[count];
        terms(item, own);
        for (int q = 0; q < count; ++q) run.at.terms[q * threads + thread] = own[q];
      },
      [&](int first, int items) {
        for (int q = thread; q < count; q += threads) {
          double sum = first == 0 ? 0.0 : sums[q];
          for (int k = 0; k < items; ++k) sum += run.at.terms[q * threads + k];
          sums[q] = sum;
        }
      });
}

/// Counts the contacts of each grain in each network. A thread counts for grains of its own.
template <class Run>
KOKKOS_FORCEINLINE_FUNCTION void count_contacts(const Run& run, const LeastForces& least, ContactCounts* counts_of) {
  const int threads = run.block.threads(), thread = run.block.thread();
  for (int i = thread; i < run.grains; i += threads) counts_of[i] = 0;
  each_tile(
      run, run.contacts,
      [&](int c) {
        run.at.keys[thread] = run.state.contact_key[c];
        run.at.counts[thread] = counts_of_contact(sums_of(run, c).normal_force, least);
      },
      [&](int, int items) {
        for (int k = 0; k < items; ++k) {
          const int i = first_of(run.at.keys[k]), j = second_of(run.at.keys[k]);
          if (i % threads == thread) counts_of[i] += run.at.counts[k];
          if (j % threads == thread) counts_of[j] += run.at.counts[k];
        }
      });
}

/// Sums the counts of all grains up, by network.
template <class Run>
KOKKOS_FORCEINLINE_FUNCTION void tally_grains(const Run& run, const ContactCounts* counts_of, GrainTally& out) {
  const int threads = run.block.threads(), thread = run.block.thread();
  GrainTally own{};
  for (int i = thread; i < run.grains; i += threads) own.add(counts_of[i]);
  run.at.tallies[thread] = own;
  run.block.barrier();
  for (int k = thread; k < networks; k += threads) {
    int twice = 0, one = 0, several = 0;
    for (int t = 0; t < threads; ++t) {
      twice += run.at.tallies[t].twice[k];
      one += run.at.tallies[t].one[k];
      several += run.at.tallies[t].several[k];
    }
    out.twice[k] = twice;
    out.one[k] = one;
    out.several[k] = several;
  }
}

/// Describes the committed state of the block's RVE. Sums that are not wanted are 0.
template <class Block>
KOKKOS_FORCEINLINE_FUNCTION void describe_block(const Block& block, const NetworkBatch& batch, int number) {
  const NetworkRun<Block> run(block, batch, number);
  double* const of_contacts = run.at.sums;
  double* const of_rotations = run.at.sums + NetworkMemory::most_sums;
  CommittedSums& out = batch.out[number];
  sum_in_order<1>(run, run.grains, of_rotations, [&](int i, double (&own)[1]) { own[0] = run.state.rotation[i]; });
  sum_in_order<3>(run, batch.sums ? run.contacts : 0, of_contacts, [&](int c, double (&own)[3]) {
    const ContactSums one = sums_of(run, c);
    own[0] = one.cosine;
    own[1] = one.sine;
    own[2] = one.normal_force;
  });
  if (block.thread() == 0) {
    for (int k = 0; k < 4; ++k) out.cell[k] = run.state.cell[k];
    out.rotation = of_rotations[0];
    out.network.contacts = run.contacts;
    out.network.of_contacts = {of_contacts[0], of_contacts[1], of_contacts[2]};
    if (!batch.tallies) out.network.tally = {};
  }
  if (!batch.tallies) return;
  ContactCounts* const counts_of = batch.counts +
                                   static_cast<std::size_t>(number) * static_cast<std::size_t>(batch.packings.stride);
  count_contacts(run, batch.thresholds.least(of_contacts[2], run.contacts), counts_of);
  tally_grains(run, counts_of, out.network.tally);
}

}  // namespace voussoir::kernels::device
