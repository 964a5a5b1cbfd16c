// The engine of GPUs on blocks of host threads, to be run with a sanitizer: every kind of call, on packings of all
// sizes. ThreadSanitizer then reports each access that no barrier orders, whatever the timing.
//
//   blocks_on_threads                     all cases; exit status 1 where an answer differs from that of one thread
//   blocks_on_threads --without NAME      the smallest cases without one barrier, which must be reported
//   blocks_on_threads --barriers          runs itself without each barrier in turn, and says which were reported

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <limits>
#include <memory>
#include <numeric>

#include "kernels/device/resident_batch.hpp"
#include "tests/device_threads.hpp"
#include "tests/engine_support.hpp"
#include "tests/tiled_packing.hpp"

namespace voussoir::kernels {
namespace {

using device::ThreadBackend;
using InMemory = ThreadBackend<device::InMemory>;
using InRegisters = ThreadBackend<device::BlockPlan<600, 200>>;
template <class real>
using Law = EngineLaw<SingleLane<real>, true>;

int faults = 0;

struct Answer {
  std::vector<RveReport> reports;
  std::vector<ServoSample> trace;
  std::vector<CommittedSums> sums = {};
};

bool same_bits(const CommittedSums& a, const CommittedSums& b) {
  using Bytes = std::array<std::byte, sizeof(CommittedSums)>;
  return std::bit_cast<Bytes>(a) == std::bit_cast<Bytes>(b);
}

/// @param what of a fault
void expect(bool right, const char* what, int rve) {
  if (right) return;
  ++faults;
  std::printf("  %s of RVE %d differs from that of one thread\n", what, rve);
}

/// Sums over threads are rounded in another order, which steps multiply.
void compare(const Answer& got, const Answer& one, double tolerance) {
  for (std::size_t k = 0; k < one.reports.size(); ++k) {
    const RveReport &a = got.reports[k], &b = one.reports[k];
    const int rve = static_cast<int>(k);
    expect(a.status == b.status, "the status", rve);
    expect(a.steps == b.steps, "the number of steps", rve);
    if (is_failure(b.status)) continue;
    expect(std::abs(a.contacts - b.contacts) <= (tolerance > 1e-6 ? 3 : 0), "the number of contacts", rve);
    const double scale = std::abs(b.stress[0]) + std::abs(b.stress[3]);
    for (int c = 0; c < 4; ++c) expect(std::abs(a.stress[c] - b.stress[c]) <= tolerance * scale, "the stress", rve);
  }
  expect(got.trace.size() == one.trace.size(), "the length of the trace", 0);
  for (std::size_t k = 0; k < one.sums.size(); ++k)
    expect(same_bits(got.sums[k], one.sums[k]), "a sum over the network", static_cast<int>(k));
}

/// Runs a case by one thread and by several.
template <class Backend, class Case>
void on_threads(const char* name, const std::vector<int>& threads, double tolerance, const Case& one_case) {
  Backend::threads = 1;
  const Answer expected = one_case();
  for (const int t : threads) {
    std::printf("%s, %d threads\n", name, t);
    std::fflush(stdout);
    Backend::threads = t;
    compare(one_case(), expected, tolerance);
  }
}

std::vector<int> all_of(std::size_t n) {
  std::vector<int> all(n);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

EngineSettings eventful() {
  EngineSettings settings;
  settings.skin = 0.0005;  // many rebases
  settings.list_interval = 1;
  settings.look_interval = 4;
  settings.guard_interval = 8;
  settings.tangent = TangentKind::elastic;
  settings.tangent_tolerance = 1e-2;
  return settings;
}

/// Two increments, in two calls with other RVEs and orders, one kept back at the commit. @param lost whether most RVEs
/// fail on their way, with several steps between looks at the list; otherwise it is looked at in each step
template <class real, class Backend>
Answer strains(const reference::Rve& rve, bool lost) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  RveBatch batch = clones(rve, 5);
  batch.committed.position(4, 3, 0) = nan;
  EngineSettings settings = eventful();
  std::vector<StrainRequest> requests(5,
                                      {.f_rel = {1.0002, 0.0006, -0.0002, 0.9996}, .strain_steps = 24, .hold_cap = 8});
  if (lost) {
    settings.skin = 0.05;
    settings.list_interval = 8;
    requests[0] = {.f_rel = {0.7, 0, 0, 0.7}, .strain_steps = 40, .hold_cap = 1};
    requests[1] = {.f_rel = {1.2, 0, 0, 1.2}, .strain_steps = 20, .hold_cap = 8};
    requests[3] = {.f_rel = {nan, 0, 0, 1}, .strain_steps = 10, .hold_cap = 1};
  }
  device::ResidentBatch<Law<real>, Backend> held(device::plain(batch));
  Answer answer{std::vector<RveReport>(5), {}};
  held.advance(std::span<const StrainRequest>(requests), settings, answer.reports, std::array{2, 0, 3});
  held.commit(std::array{2});
  held.advance(std::span<const StrainRequest>(requests), settings, answer.reports, std::array{4, 2, 1, 0});
  held.download(device::plain(batch.trial), all_of(5), true);
  return answer;
}

template <class real, class Backend>
Answer servos(const reference::Rve& rve, int steps) {
  const RveBatch batch = clones(rve, 2);
  Answer answer{std::vector<RveReport>(2), {}};
  const std::vector<ServoRequest> requests{
      {.x = {true, -1.5e5}, .y = {true, -1.2e5}, .max_rate = 1e-5, .max_steps = steps},
      {.x = {true, -1e5},
       .y = {false, -1e-6},
       .max_rate = 1e-5,
       .max_steps = steps,
       .trace = &answer.trace,
       .trace_interval = 10}};
  device::ResidentBatch<Law<real>, Backend> held(device::plain(batch));
  held.advance(std::span<const ServoRequest>(requests), eventful(), answer.reports, all_of(2));
  return answer;
}

/// Blocks whose list has no room at first.
template <class real>
Answer crowded(const reference::Rve& rve) {
  InMemory::first_pairs = static_cast<int>(rve.radii.size()) * 2;
  const Answer answer = strains<real, InMemory>(rve, true);
  InMemory::first_pairs = 0;
  return answer;
}

/// The contact networks of three states, one without contacts and one with a number that is none; first all that can be
/// asked for, then each part of it.
Answer networks_of(const reference::Rve& rve) {
  RveBatch batch = clones(rve, 3);
  batch.committed.contact_count(1) = 0;
  batch.committed.position(2, 3, 0) = std::numeric_limits<double>::quiet_NaN();
  device::ResidentBatch<Law<double>, InMemory> held(device::plain(batch));
  Answer answer;
  for (const MicrostructureRequest& wanted :
       {MicrostructureRequest{.fabric = true, .coordination = true, .strong_networks = true},
        MicrostructureRequest{.fabric = true}, MicrostructureRequest{.coordination = true}, MicrostructureRequest{}}) {
    std::vector<CommittedSums> sums(3);
    held.describe(wanted, sums);
    answer.sums.insert(answer.sums.end(), sums.begin(), sums.end());
  }
  return answer;
}

/// Grains pressed into each other until they have more contacts than a state has room for.
template <class real>
Answer squeezed(const reference::Rve& rve) {
  const RveBatch batch = clones(rve, 2);
  EngineSettings settings = eventful();
  settings.skin = 0.05;
  settings.overlap_limit = 0.95;
  const std::vector<StrainRequest> requests(2, {.f_rel = {0.6, 0, 0, 0.6}, .strain_steps = 40, .hold_cap = 1});
  device::ResidentBatch<Law<real>, InMemory> held(device::plain(batch));
  Answer answer{std::vector<RveReport>(2), {}};
  held.advance(std::span<const StrainRequest>(requests), settings, answer.reports, all_of(2));
  if (answer.reports[0].status != RveStatus::neighbour_overflow) {
    ++faults;
    std::printf("  %s, although there are too many contacts\n", name_of(answer.reports[0].status));
  }
  return answer;
}

/// One increment of a large packing, and a second one.
template <class real, class Backend>
Answer large(const reference::Rve& rve) {
  const RveBatch batch = clones(rve, 1);
  EngineSettings settings = eventful();
  settings.skin = 0.02;
  settings.list_interval = 4;
  const std::vector<StrainRequest> requests{
      {.f_rel = {1.0005, 0.0015, -0.0005, 0.999}, .strain_steps = 16, .hold_cap = 8}};
  device::ResidentBatch<Law<real>, Backend> held(device::plain(batch));
  Answer answer{std::vector<RveReport>(1), {}};
  held.advance(std::span<const StrainRequest>(requests), settings, answer.reports, all_of(1));
  held.commit({});
  held.advance(std::span<const StrainRequest>(requests), settings, answer.reports, all_of(1));
  return answer;
}

constexpr double in_float = 1e-3, in_double = 1e-9;

void run_all(const reference::Rve& small, const reference::Rve& tile) {
  for (const bool lost : {false, true}) {
    on_threads<InMemory>(lost ? "lost RVEs, double, in memory" : "rebases, double, in memory", {2, 7}, in_double,
                         [&] { return strains<double, InMemory>(small, lost); });
    on_threads<InRegisters>(lost ? "lost RVEs, float, in registers" : "rebases, float, in registers", {2, 8}, in_float,
                            [&] { return strains<float, InRegisters>(small, lost); });
  }
  on_threads<InMemory>("servos, double, in memory", {4}, in_double,
                       [&] { return servos<double, InMemory>(small, 60); });
  on_threads<InRegisters>("servos, float, in registers", {3}, in_float,
                          [&] { return servos<float, InRegisters>(small, 60); });
  on_threads<InMemory>("too little room, double", {4}, in_double, [&] { return crowded<double>(small); });
  on_threads<InMemory>("too many contacts, double", {4}, in_double, [&] { return squeezed<double>(small); });
  on_threads<InMemory>("networks", {2, 7, 32}, 0, [&] { return networks_of(small); });
  const std::array<std::array<int, 2>, 3> tiles{{{2, 3}, {2, 7}, {5, 6}}};
  for (const auto& [columns, rows] : tiles) {
    const reference::Rve rve = reference::tiled(tile, columns, rows);
    std::printf("%zu grains\n", rve.radii.size());
    on_threads<InMemory>("networks", {8}, 0, [&] { return networks_of(rve); });
    // One thread has no room for so many in registers, and answers from memory.
    on_threads<InRegisters>("large, float, in registers", {8}, in_float,
                            [&] { return large<float, InRegisters>(rve); });
    on_threads<InMemory>("large, double, in memory", {4}, in_double, [&] { return large<double, InMemory>(rve); });
  }
}

/// The cases in which every barrier is called, with few steps.
void run_small(const reference::Rve& small) {
  static_cast<void>(strains<double, InMemory>(small, false));
  static_cast<void>(large<double, InMemory>(small));
  static_cast<void>(servos<double, InMemory>(small, 12));
  static_cast<void>(networks_of(small));
}

void note_barriers(const reference::Rve& small) {
  InMemory::threads = 1;
  device::BarrierPlaces::noting = true;
  run_small(small);
  device::BarrierPlaces::noting = false;
}

int run_without(const reference::Rve& small, const char* name) {
  note_barriers(small);
  device::BarrierPlaces::leave_out(name);
  InMemory::threads = 4;
  run_small(small);
  std::printf("without %s: nothing was reported\n", name);
  return 0;
}

int run_without_each(const reference::Rve& small, const std::string& program) {
  note_barriers(small);
  int unreported = 0;
  for (const std::string& name : device::BarrierPlaces::names()) {
    std::string command = "timeout 60 ";
    command += program;
    command += " --without '";
    command += name;
    command += "' 2>&1 | grep -q 'ThreadSanitizer: '";
    // NOLINTNEXTLINE(bugprone-command-processor): a child process is what a sanitizer ends
    const bool reported = std::system(command.c_str()) == 0;
    std::printf("%-24s %s\n", name.c_str(), reported ? "reported" : "NOT REPORTED");
    if (!reported) ++unreported;
  }
  return unreported == 0 ? 0 : 1;
}

int run_program(int argc, char** argv) {
  const Kokkos::ScopeGuard kokkos(argc, argv);
  const reference::Rve small = reference::consolidated_packing(24, 2, 1e5, 0.0, reference::Material{});
  if (argc > 2 && std::strcmp(argv[1], "--without") == 0) return run_without(small, argv[2]);
  if (argc > 1 && std::strcmp(argv[1], "--barriers") == 0) return run_without_each(small, argv[0]);
  run_all(small, reference::consolidated_packing(50, 3, 1e5, 0.0, reference::Material{}));
  std::printf("%d faults\n", faults);
  return faults == 0 ? 0 : 1;
}

}  // namespace
}  // namespace voussoir::kernels

int main(int argc, char** argv) {
  try {
    return voussoir::kernels::run_program(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "blocks_on_threads: %s\n", error.what());
    return 2;
  }
}
