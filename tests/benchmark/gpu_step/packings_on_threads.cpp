/// Lists and steps of packings by threads of the host, in the instances of the graphics card (README.md): how many
/// numbers differ from those of one thread. With ThreadSanitizer it also looks for races.
/// usage: packings_on_threads PACKING...

#include <cstring>
#include <exception>

#include "tests/benchmark/gpu_step/packing_file.hpp"

namespace voussoir::gpu_step {
namespace {

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

/// Lists `rve` and takes `steps` steps with looks. Returns whether all is as one thread has it.
template <class Choice, int list_threads, int lanes>
bool same_as_one_thread(const char* name, const Rve& rve, int steps) {
  using Real = typename Choice::Real;
  using ListTeam = ThreadsTeam<list_threads>;
  using StepTeam = ThreadsTeam<Choice::threads>;
  constexpr int look_every = 8;
  const int grains = rve.grains(), kept = static_cast<int>(rve.kept.size());
  const int capacity = static_cast<int>(near_pairs(rve).size()) + 7;
  ListStore<Real> store(1, grains, capacity);
  const ListArguments<Real> list{
      grains, rve.skin, rve.position.data(), &rve.cell, rve.radius.data(), rve.kept.data(), rve.history.data(),
      &kept,  kept,     store.lists()};
  run_on_threads<ListTeam>(1, list_bytes(grains, capacity),
                           [&](const ListTeam& team) { ListThread<Real, lanes, ListTeam>(team, list).run(); });
  ListStore<Real> want = reference_list<Real>(rve, capacity);
  const bool listed = same_list(store, 0, want, grains);

  const std::vector<Real> radius(rve.radius.begin(), rve.radius.end());
  const Mat2 growth = growth_of(0);
  StepState<Real> got{std::vector<Quad<Real>>(radius.size()), std::vector<Two<Real>>(radius.size())};
  const StepArguments<Real> step{store.lists(),       radius.data(), &growth, got.state.data(), got.spin.data(),
                                 &got.report,         grains,        steps,   look_every,       0.0,
                                 literal_sand<Real>()};
  run_on_threads<StepTeam>(1, step_bytes<Choice>(grains, capacity),
                           [&](const StepTeam& team) { StepThread<Choice, StepTeam>(team, step).run(); });
  const StepState<Real> end = reference_steps<Choice::rolling>(want, rve.radius, growth, step.material, steps,
                                                               look_every);
  const bool stepped = same_bits(got.state, end.state) && same_bits(got.spin, end.spin) &&
                       std::memcmp(&got.report, &end.report, sizeof got.report) == 0 &&
                       same_list(store, 0, want, grains);
  std::printf("%-28s N %4d, %4d pairs: list %s, %d steps %s\n", name, grains, want.pair_count[0],
              listed ? "the same" : "DIFFERS", steps, stepped ? "the same" : "DIFFER");
  return listed && stepped;
}

bool check(const Rve& rve) {
  using enum Gather;
  constexpr int steps = 20;
  if (rve.grains() <= 320) {
    return same_as_one_thread<Instance<float, 160, 5, 2, 4, in_registers, false, true, Look::peeled>, 128, 8>(
        "160x5x2 registers, peeled", rve, steps);
  }
  if (rve.grains() <= 768) {
    return same_as_one_thread<Instance<float, 256, 7, 3, 2, in_registers, false, true, Look::peeled>, 256, 4>(
               "256x7x3 registers, peeled", rve, steps) &
           same_as_one_thread<Instance<double, 256, 7, 3, 2, one_list, false, true, Look::called>, 256, 1>(
               "256x7x3 list, called, double", rve, steps);
  }
  return same_as_one_thread<Instance<float, 512, 7, 3, 2, one_list, false, true, Look::called>, 512, 4>(
      "512x7x3 list, called", rve, steps);
}

}  // namespace
}  // namespace voussoir::gpu_step

int main(int argc, char** argv) {
  using namespace voussoir::gpu_step;
  bool same = argc > 1;
  try {
    for (int k = 1; k < argc; ++k) same = check(read_packing(argv[k])) && same;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "packings_on_threads: %s\n", e.what());
    return 2;
  }
  return same ? 0 : 1;
}
