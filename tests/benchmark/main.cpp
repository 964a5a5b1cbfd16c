// main of every benchmark program: Kokkos lives around all benchmarks, and its settings go into the report, because a
// rate without the backend and the thread count cannot be compared with another.
#include <benchmark/benchmark.h>

#include <Kokkos_Core.hpp>
#include <string>

int main(int argc, char** argv) {
  const Kokkos::ScopeGuard kokkos(argc, argv);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::AddCustomContext("backend", Kokkos::DefaultExecutionSpace::name());
  benchmark::AddCustomContext("concurrency", std::to_string(Kokkos::DefaultExecutionSpace().concurrency()));
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
