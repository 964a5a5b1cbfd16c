// What the pauses of an evaluation cost (host/material/piecewise.hpp): RvePool::evaluate in one go and in pieces of
// 0.3 s, on 300 grains of dense coarse sand, for a strain of 1e-3. Also from eight packings, whose groups of lanes the
// pieces must not break up.
#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "host/material/rve_pool.hpp"
#include "host/packing/recipe.hpp"

namespace voussoir::host {
namespace {

PackingMix points(std::size_t n, std::size_t packings) {
  static const std::vector<PackedRve> all = [] {
    const std::vector<std::int64_t> seeds{1, 2, 3, 4, 5, 6, 7, 8};
    PackingCase recipe;
    recipe.grains = 300;
    recipe.pressure = 1e5;
    return make_packings({}, recipe, seeds);
  }();
  return mix({all.begin(), all.begin() + static_cast<std::ptrdiff_t>(packings)}, n, 1);
}

void evaluate(benchmark::State& state, std::size_t n, std::size_t packings, bool with_pauses) {
  EngineCase engine;
  engine.backend = Backend::lanes;
  PoolOptions options = options_for_newton(engine, kernels::TangentKind::elastic, 1e-6);
  RvePool pool(points(n, packings), options);
  std::vector<fem::Gradient> gradients(n, fem::Gradient::Zero());
  for (fem::Gradient& h : gradients) h(1, 1) = -1e-3;
  std::vector<fem::Stress> stress(n);
  std::vector<fem::Tangent> tangent(n);
  int pauses = 0;
  if (with_pauses) pool.set_pause([&] { ++pauses; });
  static_cast<void>(pool.evaluate(gradients, stress, tangent));  // learns the time of a piece
  pauses = 0;
  for ([[maybe_unused]] auto _ : state) static_cast<void>(pool.evaluate(gradients, stress, tangent));
  state.counters["pieces"] = static_cast<double>(pauses) / static_cast<double>(state.iterations());
}

const bool registered = [] {
  for (const std::size_t packings : {1U, 8U}) {
    for (const std::size_t n : {16U, 1024U, 4096U}) {
      for (const bool with_pauses : {false, true}) {
        const std::string name = "rves_" + std::to_string(n) + "/packings_" + std::to_string(packings) +
                                 (with_pauses ? "/pieces" : "/one_go");
        benchmark::RegisterBenchmark(name.c_str(),
                                     [=](benchmark::State& state) { evaluate(state, n, packings, with_pauses); })
            ->Unit(benchmark::kMillisecond)
            ->UseRealTime();
      }
    }
  }
  return true;
}();

}  // namespace
}  // namespace voussoir::host
