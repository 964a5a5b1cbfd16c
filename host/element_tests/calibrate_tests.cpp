#include "host/element_tests/calibrate_tests.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "host/case/engine.hpp"
#include "host/packing/law_range.hpp"
#include "host/process/exit_code.hpp"

namespace voussoir::host {

namespace {

/// Packings of one set at all pressures, pressure by pressure. Throws NoEquilibrium where a packing does not come
/// to rest.
std::vector<PackedRve> packings_of(const TestProgram& program, const ParameterSet& set) {
  const std::vector<std::int64_t> seeds = seeds_of(program.packing);
  std::vector<PackedRve> all;
  const SoilCase soil = with_parameters(program.soil, set);
  PackingCase recipe = program.packing;
  for (const double pressure : program.biaxial.pressures) {
    recipe.pressure = pressure;
    std::vector<PackedRve> at_pressure = obtain_packings(soil, recipe, seeds, {}, Bias::left);
    if (at_pressure.size() != seeds.size()) {
      throw NoEquilibrium(fmt::format("{} of {} packings do not come to rest at {:.4g} kPa",
                                      seeds.size() - at_pressure.size(), seeds.size(), pressure * 1e-3));
    }
    for (PackedRve& rve : at_pressure) {
      rve.pressure = pressure;  // the consolidation has reached this pressure to a thousandth
      all.push_back(std::move(rve));
    }
  }
  return all;
}

/// The observables that the tests of one seed give.
Observation observe(std::span<const BiaxialCurve> curves, std::span<const Strength> strengths, std::int64_t seed) {
  std::vector<double> peak, peak_p, critical, critical_p, dilatancy;
  double strain = 0;
  for (std::size_t k = 0; k < curves.size(); ++k) {
    if (curves[k].seed != seed) continue;
    const Strength& s = strengths[k];
    peak.push_back(s.peak_angle);
    peak_p.push_back(mean_stress_at(curves[k].pressure, s.peak_angle));
    critical.push_back(s.critical_angle);
    critical_p.push_back(mean_stress_at(curves[k].pressure, s.critical_angle));
    dilatancy.push_back(s.dilatancy);
    strain += s.peak_strain;
  }
  const auto n = static_cast<double>(peak.size());
  return {common_angle(peak, peak_p), common_angle(critical, critical_p), common_dilatancy(dilatancy).mean, strain / n};
}

/// The seeds all of whose tests held (strength.hpp).
std::vector<std::int64_t> held_seeds(const std::vector<std::int64_t>& seeds, const SetTests& tests) {
  std::vector<std::int64_t> out;
  for (const std::int64_t seed : seeds) {
    bool all = true;
    for (std::size_t k = 0; k < tests.curves.size(); ++k) {
      all = all && (tests.curves[k].seed != seed || held(tests.curves[k], tests.strengths[k]));
    }
    if (all) out.push_back(seed);
  }
  return out;
}

void take_means(SetTests& tests, const std::vector<double>& pressures) {
  std::vector<Observation> each;
  for (const std::int64_t seed : tests.held_seeds) each.push_back(observe(tests.curves, tests.strengths, seed));
  const auto n = static_cast<double>(each.size());
  for (std::size_t o = 0; o < Observable::count; ++o) {
    double sum = 0, squares = 0;
    for (const Observation& one : each) sum += one[o] / n;
    for (const Observation& one : each) squares += (one[o] - sum) * (one[o] - sum);
    tests.mean[o] = sum;
    tests.deviation[o] = each.size() > 1 ? std::sqrt(squares / (n - 1)) : 0.0;
  }
  for (const double pressure : pressures) {
    double sum = 0;
    for (std::size_t k = 0; k < tests.curves.size(); ++k) {
      const bool counts = std::ranges::find(tests.held_seeds, tests.curves[k].seed) != tests.held_seeds.end();
      if (counts && tests.curves[k].pressure == pressure) sum += tests.strengths[k].contraction / n;
    }
    tests.contraction.push_back(sum);
  }
}

}  // namespace

bool SetTests::contraction_grows() const {
  return std::is_sorted(contraction.begin(), contraction.end()) && contraction.front() < contraction.back();
}

void summarise(SetTests& tests, const std::vector<std::int64_t>& seeds, const std::vector<double>& pressures) {
  tests.seeds = seeds.size();
  if (!tests.curves.empty()) tests.held_seeds = held_seeds(seeds, tests);
  if (tests.usable()) take_means(tests, pressures);
}

std::vector<SetTests> test_sets(const TestProgram& program, std::span<const ParameterSet> sets,
                                const PackingNote& note) {
  std::vector<SetTests> out(sets.size());
  std::vector<PackedRve> rves;
  std::vector<std::size_t> owner;
  for (std::size_t k = 0; k < sets.size(); ++k) {
    out[k].set = sets[k];
    try {
      for (PackedRve& rve : packings_of(program, sets[k])) {
        rves.push_back(std::move(rve));
        owner.push_back(k);
      }
    } catch (const NoEquilibrium& error) {
      out[k].fault = error.what();
      if (note) note(out[k].fault);
    }
  }
  const BiaxialCase& test = program.biaxial;
  std::vector<BiaxialCurve> curves = biaxial_tests(rves, test.strain, test.inertial_number, test.samples,
                                                   engine_settings(program.engine));
  std::size_t beyond = 0;
  for (std::size_t c = 0; c < curves.size(); ++c) {
    SetTests& of = out[owner[c]];
    if (curves[c].mean_overlap > most_mean_overlap) ++beyond;
    of.strengths.push_back(strength_of(curves[c], test.window));
    of.tests += 1;
    of.valid += held(curves[c], of.strengths.back()) ? 1 : 0;
    of.curves.push_back(std::move(curves[c]));
  }
  if (beyond > 0 && note) {
    note(fmt::format(
        "{} of {} tests do not count, because the mean overlap of their contacts passed {:.0f} % of r_i + r_j", beyond,
        owner.size(), 100 * most_mean_overlap));
  }
  for (SetTests& one : out) {
    summarise(one, seeds_of(program.packing), test.pressures);
  }
  return out;
}

}  // namespace voussoir::host
