// Speed of the engine: executed steps x grains of live lanes over the wall time of `advance` (restore, lists, 400
// steps, hold, stress and eq. (4) included). Dense coarse sand and dense gravel at 100 kPa; README.md says how to run
// and what it gave.

#include <benchmark/benchmark.h>

#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "host/case/load_case.hpp"
#include "tests/benchmark/scenes.hpp"

namespace voussoir::kernels {
namespace {

constexpr int groups = 4;  ///< more than one, so that a group finds the caches as in a run

/// CPG_D: 1500 grains of three classes, size ratio 20.
const host::PackedRve& gravel() {
  static const host::PackedRve rve = packed(host::load_case("cases/pack_gravel/case.toml"));
  return rve;
}

Scene alike(Precision precision) { return clones(sand(), groups * lanes_of(precision), precision); }

/// Every RVE has a packing of its own, so that it is spread over the lanes.
Scene alone(Precision precision) { return clones(sand(), 8, precision, 8); }

Scene grading(Precision precision) { return clones(gravel(), groups * lanes_of(precision), precision); }

Scene without_rolling(Precision precision) {
  Scene scene = alike(precision);
  for (GrainMaterial& material : scene.batch.packings[0].materials)
    material.rolling_stiffness = material.rolling_limit = 0.0;
  return scene;
}

/// The same material three times: the same motion, with every pair's constants combined from its grains' classes.
Scene three_classes(Precision precision) {
  Scene scene = alike(precision);
  Packing& packing = scene.batch.packings[0];
  packing.materials.resize(3, packing.materials[0]);
  for (int i = 0; i < packing.size(); ++i) packing.class_of.push_back(static_cast<std::uint8_t>(i % 3));
  return scene;
}

/// Length change that brings the pressure back, by the tangent of eq. (4); that it is too stiff makes it a safe choice.
double dilation_of(const RveReport& report) {
  const double bulk = 0.25 * (report.tangent[0] + 2.0 * report.tangent[1] + report.tangent[3]);
  return bulk > 0 ? 0.5 * (report.pressure() - pressure) / bulk : 0.0;
}

/// The lanes of every group sheared to eps_q = 10 % in W equally spaced directions at constant pressure, then one
/// increment more.
Scene apart(Precision precision) {
  Scene scene = alike(precision);
  const std::size_t width = lanes_of(precision);
  std::vector<RveReport> reports(scene.batch.size());
  const auto aim = [&](std::size_t k) {
    const double angle = std::numbers::pi * static_cast<double>(k % width) / static_cast<double>(width);
    scene.requests[k].f_rel = sheared(angle, increment, dilation_of(reports[k]));
  };
  for (int n = 0; n <= std::lround(0.1 / increment); ++n) {
    for (std::size_t k = 0; k < scene.batch.size(); ++k) {
      if (is_failure(reports[k].status)) throw std::runtime_error("a lane was lost while it was sheared");
      aim(k);
    }
    if (n == std::lround(0.1 / increment)) break;
    advance(scene.batch, std::span<const StrainRequest>(scene.requests), scene.settings, reports);
    commit(scene.batch);
  }
  return scene;
}

/// 512 RVEs of 100 to 1000 steps, in no order: what two threads make of it beside one is the schedule's.
Scene unequal(Precision precision) {
  constexpr std::size_t n = 512, stride = 197;  // without a common divisor: all of 0 .. n - 1 come
  Scene scene = clones(sand(), n, precision);
  for (std::size_t k = 0; k < n; ++k) {
    const double share = static_cast<double>(k * stride % n) / static_cast<double>(n - 1);
    StrainRequest& request = scene.requests[k];
    request.strain_steps = static_cast<int>(std::lround(100.0 * std::pow(10.0, share)));
    request.f_rel = sheared(0.0, increment * request.strain_steps / strain_steps, 0.0);
  }
  return scene;
}

/// Made once, whatever the number of repetitions; gone before Kokkos is.
Scene& scene_of(const std::string& name, const std::function<Scene()>& make) {
  static std::map<std::string, Scene> scenes;
  if (scenes.empty()) Kokkos::push_finalize_hook([] { scenes.clear(); });
  const auto found = scenes.find(name);
  return found != scenes.end() ? found->second : scenes.emplace(name, make()).first->second;
}

void measure(benchmark::State& state, Scene& scene) {
  std::vector<RveReport> reports(scene.batch.size());
  std::size_t particle_steps = 0;
  for ([[maybe_unused]] auto _ : state) {
    forget_candidates(scene.batch);  // lists are part of what is timed
    particle_steps += advance(scene.batch, std::span<const StrainRequest>(scene.requests), scene.settings, reports)
                          .particle_steps;
  }
  double contacts = 0, listed = 0, steps = 0, contact_steps = 0, listed_steps = 0;
  for (std::size_t k = 0; k < reports.size(); ++k) {
    const RveReport& report = reports[k];
    if (is_failure(report.status)) return state.SkipWithError(name_of(report.status));
    const auto pairs = static_cast<double>(scene.batch.candidates.keys[k].size());
    contacts += report.contacts;
    listed += pairs;
    steps += report.steps;
    contact_steps += static_cast<double>(report.contacts) * report.steps;
    listed_steps += pairs * report.steps;
  }
  const auto cells = static_cast<double>(scene.batch.size());
  const double grains = scene.batch.packings[0].size();
  state.counters["particle_steps/s"] = benchmark::Counter(static_cast<double>(particle_steps),
                                                          benchmark::Counter::kIsRate);
  const auto rate = [&](double each) {
    return benchmark::Counter(each * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
  };
  state.counters["contact_steps/s"] = rate(contact_steps);
  state.counters["pair_steps/s"] = rate(listed_steps);
  state.counters["pairs"] = listed / (cells * grains);
  state.counters["cells"] = cells;
  state.counters["grains"] = grains;
  state.counters["steps"] = steps / cells;
  state.counters["coordination"] = 2.0 * contacts / (cells * grains);
  state.counters["skin"] = scene.settings.skin;
}

void add(const std::string& name, int iterations, Scene (*make)(Precision)) {
  for (const auto& [text, precision] :
       {std::pair{"float", Precision::float32}, std::pair{"double", Precision::float64}}) {
    const std::string full = name + "/" + text;
    benchmark::RegisterBenchmark(full.c_str(),
                                 [make, full, chosen = precision](benchmark::State& state) {
                                   measure(state, scene_of(full, [=] { return make(chosen); }));
                                 })
        ->Iterations(iterations)
        ->Repetitions(5)
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
  }
}

[[maybe_unused]] const bool added = [] {
  add("alike", 8, alike);
  add("apart", 8, apart);
  add("alone", 8, alone);
  add("without_rolling", 8, without_rolling);
  add("three_classes", 8, three_classes);
  add("grading", 4, grading);
  add("unequal_steps", 1, unequal);
  return true;
}();

}  // namespace
}  // namespace voussoir::kernels
