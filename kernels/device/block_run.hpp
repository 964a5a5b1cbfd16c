#pragma once
/// One block at work on one RVE: where its numbers are.
///
/// What a step touches stands in registers and in the block's fast memory: a pair's state in the registers of the
/// thread that owns it (`BlockSlots`), grains and the actions of pairs in fast memory. Everything else is in the memory
/// of the device, and so are the pairs before and after the loop of steps.

#include <cstdint>

#include "kernels/course/rve_course.hpp"
#include "kernels/course/rve_report.hpp"
#include "kernels/device/block.hpp"
#include "kernels/device/block_batch.hpp"
#include "kernels/tangents/contact_springs.hpp"

namespace voussoir::kernels::device {

inline constexpr int threads_of_group = 16;    ///< whose numbers one thread sums up
inline constexpr int most_sums = 6;            ///< numbers that `reduce` joins at once
inline constexpr int candidates_per_pair = 2;  ///< room for candidates, by room for pairs
inline constexpr double candidate_skin = 1.5;  ///< of the candidates, over that of the list

/// The data of one thread that the others read.
template <class real, class Drive>
struct BlockControl {
  RveCourse<Drive> course;
  CellMotion<SingleLane<real>> motion[2];  ///< of this step and of the next one
  Mat2 cell;                               ///< at the last rebase
  int last;                                ///< step of the present segment
  ListState list;                          ///< result of the last look
  double told[4];                          ///< numbers that one thread tells the others
};

/// The numbers of a pair that its thread keeps in registers: its branch at the last rebase, and its history.
template <class Law>
struct HeldPair {
  typename Law::Value branch_x, branch_y;
  typename Law::History history;
};

/// Motion of one grain under one unit strain.
template <class real>
struct GrainAnswer {
  real x, y, spin;
};

/// One unit strain's solution of a tangent for one grain, scaled as in tangents/grain_blocks.hpp.
template <class V>
struct SolverSlot {
  Triangle<V> scale;
  GrainDofs<V> motion, residual, direction;
  GrainDofs<V> image;  ///< minus the product of K with the direction
};

/// Numbers that `reduce` needs for `count` sums: one of each thread, and one of each group of threads.
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION constexpr int room_of_sums(int count, int threads) {
  return count * (threads + (threads + threads_of_group - 1) / threads_of_group);
}
/// Numbers of the bins' scratch: three by grain, and one more by bin, of which there are as many as grains at most.
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION constexpr int room_of_bins(int grains) { return 4 * grains + 1; }

/// Entries of BlockMemory::action: those of the pairs, and at least the room for sums and bins.
template <class real>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION constexpr int room_of_action(int grains, int capacity, int threads) {
  constexpr int entry = static_cast<int>(sizeof(Four<real>));
  const int sums = room_of_sums(most_sums, threads) * static_cast<int>(sizeof(double));
  const int bins = room_of_bins(grains) * static_cast<int>(sizeof(int));
  const int scratch = ((sums < bins ? bins : sums) + entry - 1) / entry;
  return capacity < scratch ? scratch : capacity;
}

template <class Law, class Drive, class Plan>
struct BlockMemory {
  using V = typename Law::Value;
  using real = real_of<V>;
  /// Pairs are numbered in 16 bits where there are few.
  using Index = std::conditional_t<Plan::in_registers, std::uint16_t, std::uint32_t>;

  // In fast memory.
  BlockControl<real, Drive>* control;
  Four<real>* motion;   ///< by grain: u_x, u_y, w_x, w_y
  Two<real>* rim;       ///< by grain: spin, radius
  Two<real>* mobility;  ///< by grain: dt^2/m, dt^2/J
  real* rotation;       ///< by grain, since the committed state [rad]
  std::uint32_t* keys;  ///< by pair
  real* gap;            ///< by pair, at the last rebase [m^2]
  Four<real>* action;   ///< by pair: force on i, torque on i and on j; between steps the scratch of sums and lists
  Index* row;           ///< pairs of grain i, in which it is the first or the second: its entries row[i] .. row[i + 1]
  Index* entries;       ///< 2 p, or 2 p + 1 where the grain is the second one of pair p; ascending for each grain
  int* counts;          ///< scratch of sums_before
  // In the device's memory.
  std::uint32_t* kept_key;     ///< of a rebase, by pair
  real* kept_history;          ///< (pair, k)
  SpringLanes<V>* springs;     ///< of a tangent, by pair
  GrainAnswer<real>* answers;  ///< of a tangent, (unit strain, grain)
  HeldPair<Law>* pairs;        ///< with the plan InMemory
  real* pair_numbers;          ///< with another one, outside the loop of steps: HeldPair as (number, pair)
  SolverSlot<V>* solver;       ///< with the plan InMemory
  // How much of each.
  std::size_t fast_bytes, slow_bytes;

  /// @param fast, slow memories of the block; no_memory() where only their sizes are wanted
  /// @param n grains; @param capacity pairs
  KOKKOS_FORCEINLINE_FUNCTION BlockMemory(char* fast, char* slow, int n, int capacity, int threads) {
    Carver in_fast(fast), in_slow(slow);
    Carver& of_grains = Plan::in_registers ? in_fast : in_slow;
    control = in_fast.take<BlockControl<real, Drive>>(1);
    counts = in_fast.take<int>(threads + threads / threads_of_group + 2);
    motion = of_grains.template take<Four<real>>(n);
    rim = of_grains.template take<Two<real>>(n);
    mobility = of_grains.template take<Two<real>>(n);
    rotation = of_grains.template take<real>(n);
    keys = of_grains.template take<std::uint32_t>(capacity);
    gap = of_grains.template take<real>(capacity);
    action = of_grains.template take<Four<real>>(room_of_action<real>(n, capacity, threads));
    row = of_grains.template take<Index>(n + 1);
    entries = of_grains.template take<Index>(2 * capacity);
    kept_key = in_slow.take<std::uint32_t>(capacity);
    kept_history = in_slow.take<real>(capacity * history_size<Law>);
    springs = in_slow.take<SpringLanes<V>>(capacity);
    answers = in_slow.take<GrainAnswer<real>>(unit_strains * n);
    pairs = in_slow.take<HeldPair<Law>>(Plan::in_registers ? 0 : capacity);
    pair_numbers = in_slow.take<real>(Plan::in_registers ? (2 + history_size<Law>)*capacity : 0);
    solver = in_slow.take<SolverSlot<V>>(Plan::in_registers ? 0 : n);
    fast_bytes = in_fast.used();
    slow_bytes = in_slow.used();
  }
};

/// Where a block finds everything. It is small, so that functions outside the loop of steps take it by value.
template <class Block, class Batch>
struct BlockSeat {
  Block block;
  const Batch* batch;
  const EngineSettings* settings;
  char* slow;       ///< memory of the block on the device
  int number;       ///< of the block in its launch
  int most_grains;  ///< for which its memories have room
  int capacity;     ///< pairs for which they have room
  int listed = 0;   ///< pairs in the list
};

/// @tparam Classes whether grains of one packing have unlike materials
template <class LawType, class DriveType, class BlockType, class PlanType, bool Classes>
struct BlockRun {
  using Law = LawType;
  using V = typename Law::Value;
  using real = real_of<V>;
  using Drive = DriveType;
  using Block = BlockType;
  using Plan = PlanType;
  using Memory = BlockMemory<Law, Drive, Plan>;
  using Index = typename Memory::Index;
  using Batch = BlockBatch<real, Drive>;
  using Seat = BlockSeat<Block, Batch>;
  static constexpr bool classes = Classes;

  Block block;
  const Batch& batch;
  const EngineSettings& settings;
  int number;  ///< of the block in its launch
  int rve, packing, grains;
  int capacity;                          ///< pairs for which the block has room
  int listed;                            ///< pairs in the list
  GrainMaterialOf<real> first_material;  ///< of all grains where there are no classes
  Memory at;

  KOKKOS_FORCEINLINE_FUNCTION explicit BlockRun(const Seat& seat)
      : block(seat.block),
        batch(*seat.batch),
        settings(*seat.settings),
        number(seat.number),
        rve(batch.order[number]),
        packing(batch.packing_of[rve]),
        grains(batch.packings.scales[packing].grains),
        capacity(seat.capacity),
        listed(seat.listed),
        first_material(batch.packings.materials[packing * batch.packings.class_stride]),
        at(block.fast_memory(), seat.slow, seat.most_grains, capacity, block.threads()) {}

  [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION const RunScales& scales() const { return batch.packings.scales[packing]; }
  [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION RveCourse<Drive>& course() const { return at.control->course; }
  [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION std::size_t grain(int i) const {
    return static_cast<std::size_t>(packing) * static_cast<std::size_t>(batch.packings.stride) +
           static_cast<std::size_t>(i);
  }
  [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION double radius(int i) const { return batch.packings.radii[grain(i)]; }
  [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION const GrainMaterialOf<real>& material(int i) const {
    if constexpr (!classes) return first_material;
    return batch.packings.materials[packing * batch.packings.class_stride + batch.packings.class_of[grain(i)]];
  }
  /// Where the block's candidates stand among those of all.
  [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION int candidates() const { return batch.candidates.of_blocks ? number : rve; }
  [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION DeviceState committed() const {
    return state_of(batch.states, batch.states.committed_slot[rve], rve);
  }
  [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION DeviceState trial() const {
    return state_of(batch.states, 1 - batch.states.committed_slot[rve], rve);
  }
};

/// Calls body(i) for i = 0 .. n - 1, each by one thread. The caller sets the barrier.
template <class Run, class Body>
KOKKOS_FORCEINLINE_FUNCTION void each(const Run& run, int n, const Body& body) {
  for (int i = run.block.thread(); i < n; i += run.block.threads()) body(i);
}

/// Calls body(p) for all pairs of the list.
template <class Run, class Body>
KOKKOS_FORCEINLINE_FUNCTION void each_pair(const Run& run, const Body& body) {
  each(run, run.listed, body);
}
/// Calls body(i) for all grains.
template <class Run, class Body>
KOKKOS_FORCEINLINE_FUNCTION void each_grain(const Run& run, const Body& body) {
  each(run, run.grains, body);
}
/// Calls body(k, i) for the items i < n in the slots k of a thread.
template <class Run, class Held, class Body>
KOKKOS_FORCEINLINE_FUNCTION void each_held(const Run& run, const Held& slots, int n, const Body& body) {
  const int threads = run.block.threads(), thread = run.block.thread();
#if defined(__CUDA_ARCH__)
#pragma unroll
#endif
  for (int k = 0; k < slots.size(); ++k) {
    const int i = k * threads + thread;
    if (i < n) body(k, i);
  }
}

/// Calls body() by one thread, and lets the others wait.
template <class Run, class Body>
KOKKOS_FORCEINLINE_FUNCTION void alone(const Run& run, const Body& body) {
  if (run.block.thread() == 0) body();
  run.block.barrier();
}

/// What the thread of pair p holds of it, outside the loop of steps.
template <class Run>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION HeldPair<typename Run::Law> held_pair(const Run& run, int p) {
  using V = typename Run::V;
  using Law = typename Run::Law;
  if constexpr (!Run::Plan::in_registers) return run.at.pairs[p];
  const auto* const numbers = run.at.pair_numbers + p;
  HeldPair<Law> pair{V(numbers[0]), V(numbers[run.capacity]), {}};
  read_history<Law>(pair.history, 0, [&](int q) { return numbers[(2 + q) * run.capacity]; });
  return pair;
}
/// The same with the numbers in fast memory: the pair as the lanes have it.
template <class Run>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION PairLanes<typename Run::Law> pair_of(
    const Run& run, int p, const HeldPair<typename Run::Law>& held) {
  return {held.branch_x, held.branch_y, typename Run::V(run.at.gap[p]), held.history};
}
template <class Run>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION PairLanes<typename Run::Law> pair_of(const Run& run, int p) {
  return pair_of(run, p, held_pair(run, p));
}
/// Stores the history of pair p.
template <class Run>
KOKKOS_FORCEINLINE_FUNCTION void set_history(const Run& run, int p, const typename Run::Law::History& history) {
  using Law = typename Run::Law;
  if constexpr (Run::Plan::in_registers) {
    write_history<Law>(history, 0, [&](int q, const typename Run::real& number) {
      run.at.pair_numbers[(2 + q) * run.capacity + p] = number;
    });
  } else {
    run.at.pairs[p].history = history;
  }
}
template <class Run>
KOKKOS_FORCEINLINE_FUNCTION void set_pair(const Run& run, int p, const PairLanes<typename Run::Law>& pair) {
  run.at.gap[p] = pair.gap[0];
  if constexpr (Run::Plan::in_registers) {
    run.at.pair_numbers[p] = pair.branch_x[0];
    run.at.pair_numbers[run.capacity + p] = pair.branch_y[0];
    set_history(run, p, pair.history);
  } else {
    run.at.pairs[p] = {pair.branch_x, pair.branch_y, pair.history};
  }
}

/// The pairs of a thread during the loop of steps.
template <class Run>
struct BlockSlots {
  static constexpr bool in_registers = Run::Plan::in_registers;
  Slots<HeldPair<typename Run::Law>, Run::Plan::pair_slots> pair;

  KOKKOS_FORCEINLINE_FUNCTION explicit BlockSlots(const Run& run)
      : pair(run.at.pairs, run.listed, run.block.thread(), run.block.threads()) {}

  /// Takes the pairs over from the device's memory.
  KOKKOS_FORCEINLINE_FUNCTION void load(const Run& run) {
    if constexpr (in_registers) each_held(run, pair, run.listed, [&](int k, int p) { pair[k] = held_pair(run, p); });
  }
  /// Gives their histories back.
  KOKKOS_FORCEINLINE_FUNCTION void store(const Run& run) {
    if constexpr (in_registers) {
      each_held(run, pair, run.listed, [&](int k, int p) { set_history(run, p, pair[k].history); });
    }
    run.block.barrier();
  }
};

}  // namespace voussoir::kernels::device
