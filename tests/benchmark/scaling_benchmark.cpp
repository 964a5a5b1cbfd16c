// How the cost of the engine grows with the number of RVEs, of grains and of packings: time of a particle-step and
// memory of a grain, which should not change. Dense coarse sand at 100 kPa in float; README.md says how to run and what
// it gave.

#include <benchmark/benchmark.h>
#include <malloc.h>

#include <fstream>
#include <map>
#include <stdexcept>
#include <string>

#include "tests/benchmark/scenes.hpp"

namespace voussoir::kernels {
namespace {

const host::PackedRve& sand_of(int grains) {
  static std::map<int, host::PackedRve> all;
  const auto found = all.find(grains);
  if (found != all.end()) return found->second;
  host::Case input;
  input.packing.grains = grains;
  return all.emplace(grains, packed(input)).first->second;
}

/// Memory of this process that is in use now [B].
double memory_in_use() {
  std::ifstream file("/proc/self/status");
  for (std::string word; file >> word;) {
    if (word != "VmRSS:") continue;
    double kilobytes = 0;
    file >> kilobytes;
    return 1024 * kilobytes;
  }
  throw std::runtime_error("/proc/self/status does not tell the memory in use");
}

void measure(benchmark::State& state, std::size_t n, int grains, std::size_t packings) {
  const host::PackedRve& rve = sand_of(grains);
  malloc_trim(0);  // gives back what the scene before has freed
  const double before = memory_in_use();
  Scene scene = clones(rve, n, Precision::float32, packings);
  for (StrainRequest& request : scene.requests) request.strain_steps = 100;
  std::vector<RveReport> reports(n);
  const auto all = [&] {
    return advance(scene.batch, std::span<const StrainRequest>(scene.requests), scene.settings, reports).particle_steps;
  };
  all();  // touches all memory and finds the candidates, which outlive an evaluation
  const double bytes = (memory_in_use() - before) / (static_cast<double>(n) * grains);
  std::size_t particle_steps = 0;
  for ([[maybe_unused]] auto _ : state) particle_steps += all();
  state.counters["particle_steps/s"] = benchmark::Counter(static_cast<double>(particle_steps),
                                                          benchmark::Counter::kIsRate);
  state.counters["bytes/grain"] = bytes;
}

void add(std::size_t n, int grains, std::size_t packings) {
  const std::string name = "rves_" + std::to_string(n) + "/grains_" + std::to_string(grains) + "/packings_" +
                           std::to_string(packings);
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) { measure(state, n, grains, packings); })
      ->Repetitions(3)
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
}

[[maybe_unused]] const bool added = [] {
  for (const std::size_t packings : {1, 8}) {
    for (const std::size_t n : {64, 256, 1024, 4096, 16384}) add(n, 300, packings);
    for (const int grains : {100, 700, 1500, 3000}) add(1024, grains, packings);
  }
  return true;
}();

}  // namespace
}  // namespace voussoir::kernels
