#pragma once
/// One block at work on one RVE: where its numbers are.
///
/// What a step touches stands in registers and in the block's fast memory: a pair's state in the registers of the
/// thread that owns it, grains and the actions of pairs in fast memory. Everything else is in the memory of the device.

#include <cstdint>

#include "kernels/course/rve_course.hpp"
#include "kernels/course/rve_report.hpp"
#include "kernels/device/block.hpp"
#include "kernels/device/block_batch.hpp"
#include "kernels/tangents/contact_springs.hpp"

namespace voussoir::kernels::device {

inline constexpr int threads_of_group = 16;     ///< whose numbers one thread sums up
inline constexpr int candidates_per_pair = 2;   ///< room for candidates, by room for pairs
inline constexpr double candidate_skin = 1.5;   ///< of the candidates, over that of the list

/// The data of one thread that the others read.
template <class real, class Drive>
struct BlockControl {
  RveCourse<Drive> course;
  CellMotion<SingleLane<real>> motion[2];  ///< of this step and of the next one
  Mat2 cell;                               ///< at the last rebase
  ListState list;                          ///< result of the last look
  double told[4];                          ///< numbers that one thread tells the others
};

/// The numbers of a grain that only its own thread needs.
template <class real>
struct GrainOwn {
  real rotation;  ///< since the committed state [rad]
  real mobility, rotational_mobility;
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
  Four<real>* action;   ///< by pair: force on i, torque on i and on j; between steps the scratch of sums and lists
  Index* row;           ///< pairs of grain i: row[i] .. row[i + 1]
  Index* incoming_end;  ///< pairs (h, i), h < i: incoming[incoming_end[i - 1] .. incoming_end[i]], ascending
  Index* incoming;
  int* counts;          ///< scratch of sums_before
  // In the device's memory.
  std::uint32_t* kept_key;        ///< of a rebase, by pair
  real* kept_history;             ///< (pair, k)
  SpringLanes<V>* springs;        ///< of a tangent, by pair
  GrainAnswer<real>* answers;     ///< of a tangent, (unit strain, grain)
  PairLanes<Law>* pairs;          ///< with the plan InMemory, as are the next three
  std::uint32_t* keys;
  GrainOwn<real>* own;
  SolverSlot<V>* solver;
  // How much of each.
  std::size_t fast_bytes, slow_bytes;

  /// @param fast, slow memories of the block, or null pointers, with which the bytes are counted
  /// @param n grains; @param capacity pairs
  KOKKOS_INLINE_FUNCTION BlockMemory(char* fast, char* slow, int n, int capacity, int threads) {
    Carver in_fast(fast), in_slow(slow);
    Carver& of_grains = Plan::in_registers ? in_fast : in_slow;
    control = in_fast.take<BlockControl<real, Drive>>(1);
    counts = in_fast.take<int>(threads + threads / threads_of_group + 2);
    motion = of_grains.template take<Four<real>>(n);
    rim = of_grains.template take<Two<real>>(n);
    action = of_grains.template take<Four<real>>(capacity);
    row = of_grains.template take<Index>(n + 1);
    incoming_end = of_grains.template take<Index>(n);
    incoming = of_grains.template take<Index>(capacity);
    kept_key = in_slow.take<std::uint32_t>(capacity);
    kept_history = in_slow.take<real>(capacity * history_size<Law>);
    springs = in_slow.take<SpringLanes<V>>(capacity);
    answers = in_slow.take<GrainAnswer<real>>(unit_strains * n);
    pairs = in_slow.take<PairLanes<Law>>(Plan::in_registers ? 0 : capacity);
    keys = in_slow.take<std::uint32_t>(Plan::in_registers ? 0 : capacity);
    own = in_slow.take<GrainOwn<real>>(Plan::in_registers ? 0 : n);
    solver = in_slow.take<SolverSlot<V>>(Plan::in_registers ? 0 : n);
    fast_bytes = in_fast.used();
    slow_bytes = in_slow.used();
  }
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
  static constexpr bool classes = Classes;

  Block block;
  const BlockBatch<real, Drive>& batch;
  const EngineSettings& settings;
  int number;  ///< of the block in its launch
  int rve, packing, grains;
  int capacity;    ///< pairs for which the block has room
  int listed = 0;  ///< pairs in the list
  GrainMaterialOf<real> first_material;  ///< of all grains where there are no classes
  Memory at;
  Slots<PairLanes<Law>, Plan::pair_slots> pair;
  Slots<std::uint32_t, Plan::pair_slots> key;
  Slots<GrainOwn<real>, Plan::grain_slots> own;

  /// @param place number of the block; @param fast, slow its memories; @param room pairs
  KOKKOS_INLINE_FUNCTION BlockRun(const Block& threads, const BlockBatch<real, Drive>& all, const EngineSettings& s,
                                  int place, char* fast, char* slow, int room)
      : block(threads),
        batch(all),
        settings(s),
        number(place),
        rve(all.order[place]),
        packing(all.packing_of[rve]),
        grains(all.packings.scales[packing].grains),
        capacity(room),
        first_material(all.packings.materials[packing * all.packings.class_stride]),
        at(fast, slow, all.packings.stride, room, threads.threads()),
        pair(at.pairs, room, threads.thread(), threads.threads()),
        key(at.keys, room, threads.thread(), threads.threads()),
        own(at.own, grains, threads.thread(), threads.threads()) {}

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

/// Calls body(k, i) for the items i < n in the slots k of a thread.
template <class Run, class Held, class Body>
KOKKOS_FORCEINLINE_FUNCTION void each_of(const Run& run, const Held& slots, int n, const Body& body) {
  const int threads = run.block.threads(), thread = run.block.thread();
#if defined(__CUDA_ARCH__)
#pragma unroll
#endif
  for (int k = 0; k < slots.size(); ++k) {
    const int i = k * threads + thread;
    if (i < n) body(k, i);
  }
}
template <class Run, class Body>
KOKKOS_FORCEINLINE_FUNCTION void each_pair(const Run& run, const Body& body) {
  each_of(run, run.pair, run.listed, body);
}
template <class Run, class Body>
KOKKOS_FORCEINLINE_FUNCTION void each_grain(const Run& run, const Body& body) {
  each_of(run, run.own, run.grains, body);
}

/// Calls body() by one thread, and lets the others wait.
template <class Run, class Body>
KOKKOS_FORCEINLINE_FUNCTION void alone(const Run& run, const Body& body) {
  if (run.block.thread() == 0) body();
  run.block.barrier();
}

}  // namespace voussoir::kernels::device
