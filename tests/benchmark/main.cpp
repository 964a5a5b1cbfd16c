// main of every benchmark program: Kokkos lives around all benchmarks, and device, backend and thread count go into the
// report, because a rate without them cannot be compared with another.
#include <benchmark/benchmark.h>

#include <Kokkos_Core.hpp>
#include <fstream>
#include <string>

#include "kernels/isa/choose_lanes.hpp"

namespace {

/// The processor's name as Linux gives it.
std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

}  // namespace

int main(int argc, char** argv) {
  const Kokkos::ScopeGuard kokkos(argc, argv);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  using voussoir::kernels::chosen_lanes, voussoir::kernels::lanes_sentence;
  benchmark::AddCustomContext("device", processor());
  benchmark::AddCustomContext("lanes", lanes_sentence(chosen_lanes()));
  benchmark::AddCustomContext("backend", Kokkos::DefaultExecutionSpace::name());
  benchmark::AddCustomContext("concurrency", std::to_string(Kokkos::DefaultExecutionSpace().concurrency()));
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
