#pragma once
/// What a step is compiled for, what it is given, and how it lays its shared memory out.

#include "tests/benchmark/gpu_step/pair_lists.hpp"
#include "tests/benchmark/gpu_step/pair_step.hpp"

namespace voussoir::gpu_step {

/// How a grain finds the actions of its pairs.
enum class Gather {
  two_loops,    ///< a loop over incoming pairs by index, then one over its own row
  one_list,     ///< one loop over the indices of both kinds
  in_registers  ///< up to 8 indices in registers of the grain's thread
};
constexpr int most_in_registers = 8;

/// How a step looks (every `look_every` steps).
enum class Look {
  none,
  peeled,  ///< the step that looks is a second copy of the step behind an inner loop of plain steps
  called   ///< a function that is not inlined looks between the two parts of a step (look_from_list)
};

/// One choice of all that is known when compiling.
/// @tparam Threads of a team: a multiple of 32; @tparam PairSlots, GrainSlots of a thread; @tparam Blocks that a
/// multiprocessor shall hold, which bounds the registers
template <class Value, int Threads, int PairSlots, int GrainSlots, int Blocks, Gather GatherBy, bool Branch = false,
          bool Rolling = true, Look LookBy = Look::none>
struct Instance {
  using Real = Value;
  static constexpr int threads = Threads, pair_slots = PairSlots, grain_slots = GrainSlots, blocks = Blocks;
  static constexpr Gather gather = GatherBy;
  static constexpr bool branch = Branch, rolling = Rolling;
  static constexpr Look look = LookBy;
};

/// What a look finds.
struct LookReport {
  Mat2 stress;           ///< sum of f (x) l over all pairs [N m]
  double force_squared;  ///< sum over all grains [N^2]
};

/// Partial sums of a look in shared memory.
template <class Real>
struct LookSums {
  Stress<Real>* of_pairs;  ///< (pair_chunks)
  Real* of_grains;         ///< (grain_chunks)
  int pair_chunks, grain_chunks;
  LookReport* report;
};

template <class Real>
struct StepArguments {
  PairLists<Real> lists;  ///< histories go on
  const Real* radius;     ///< (grains) [m]
  const Mat2* growth;     ///< (rve) the cell's E of each step
  Quad<Real>* state;      ///< (rve, grains) displacement and fluctuation at the end, as in Shared
  Two<Real>* spin;        ///< (rve, grains) rotation a step and rotation since the start [rad]
  LookReport* report;     ///< (rve) of the last look
  int grains, steps;
  int look_every;
  double rest;  ///< an RVE ends where the sum of squared forces is below this [N^2]; 0 is never
  Material<Real> material;
};

/// An RVE's arrays in shared memory.
template <class Real>
struct StepMemory {
  Shared<Real> s;
  Motion<Real>* motion;  ///< (2) of this step and of the next
  Mat2* cell;            ///< F - I
  LookSums<Real> sums;
};

template <class Instance>
VOUSSOIR_DEVICE StepMemory<typename Instance::Real> carve_step(Carver& carver, int grains, int capacity) {
  using Real = typename Instance::Real;
  StepMemory<Real> m{};
  m.s.grain = carver.take<Quad<Real>>(grains);
  m.s.action = carver.take<Quad<Real>>(capacity + 1);
  m.motion = carver.take<Motion<Real>>(2);
  m.s.spin_radius = carver.take<Two<Real>>(grains);
  m.cell = carver.take<Mat2>(1);
  if constexpr (Instance::look != Look::none) {
    m.sums.pair_chunks = Instance::pair_slots * (Instance::threads / 32);
    m.sums.grain_chunks = Instance::grain_slots * (Instance::threads / 32);
    m.sums.of_pairs = carver.take<Stress<Real>>(m.sums.pair_chunks);
    m.sums.of_grains = carver.take<Real>(m.sums.grain_chunks);
    m.sums.report = carver.take<LookReport>(1);
  }
  if constexpr (Instance::gather != Gather::in_registers) m.s.row = carver.take<std::uint16_t>(grains + 1);
  if constexpr (Instance::gather == Gather::two_loops) m.s.incoming_row = carver.take<std::uint16_t>(grains + 1);
  if constexpr (Instance::gather != Gather::in_registers) {
    m.s.indices = carver.take<std::uint16_t>(Instance::gather == Gather::one_list ? 2 * capacity : capacity);
  }
  return m;
}

template <class Instance>
std::size_t step_bytes(int grains, int capacity) {
  Carver carver(nullptr);
  carve_step<Instance>(carver, grains, capacity);
  return carver.bytes();
}

}  // namespace voussoir::gpu_step
