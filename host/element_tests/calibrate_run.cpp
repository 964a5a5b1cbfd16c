#include "host/element_tests/calibrate_run.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "host/element_tests/calibrate_tests.hpp"
#include "host/record/provenance.hpp"
#include "host/record/remarks.hpp"
#include "io/result_file.hpp"

namespace voussoir::host {

namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr std::array<const char*, Observable::count> observable_names{"peak_angle", "critical_angle", "dilatancy_angle",
                                                                      "peak_strain"};
constexpr std::array<const char*, Parameter::count> parameter_names{"rolling_stiffness", "rolling_limit", "thickness"};
constexpr std::array<const char*, Parameter::count> parameter_units{"-", "-", "m"};

const char* unit_of(std::size_t observable) { return observable == Observable::peak_strain ? "-" : "rad"; }

void print(const char* label, const SetTests& one, const CalibrateCase& targets) {
  std::printf("%-8s beta %.4f  eta %.4f  t %.4f m: ", label, one.set[Parameter::rolling_stiffness],
              one.set[Parameter::rolling_limit], one.set[Parameter::thickness]);
  if (!one.usable()) {
    const std::string held = fmt::format("{} of {} tests, {} of {} packings held", one.valid, one.tests,
                                         one.held_seeds.size(), one.seeds);
    std::printf("not usable: %s\n", one.fault.empty() ? held.c_str() : one.fault.c_str());
    return;
  }
  const Observation &m = one.mean, &s = one.deviation;
  std::printf(
      "phi_p %5.1f +- %.1f  phi_cs %5.1f +- %.1f  psi_max %5.1f +- %.1f deg  peak at %4.1f +- %.1f %%  contraction",
      m[0] / degree, s[0] / degree, m[1] / degree, s[1] / degree, m[2] / degree, s[2] / degree, m[3] * 100, s[3] * 100);
  for (const double contraction : one.contraction) std::printf(" %.2f", contraction * 100);
  std::printf(" %%  misfit %.2f", misfit(m, targets));
  if (one.valid < one.tests) std::printf("  (%zu of %zu packings held)", one.held_seeds.size(), one.seeds);
  std::printf("\n");
}

/// A table with one row for each set: its parameters, and the results of its tests.
std::vector<io::TableColumn> table_of(const std::vector<SetTests>& sets, const std::vector<double>& rounds,
                                      const CalibrateCase& targets) {
  std::vector<io::TableColumn> columns{{"round", "-", rounds}, {"usable", "-", {}}, {"misfit", "-", {}}};
  for (const SetTests& one : sets) {
    columns[1].values.push_back(one.usable() ? 1.0 : 0.0);
    columns[2].values.push_back(one.usable() ? misfit(one.mean, targets) : std::nan(""));
  }
  for (std::size_t p = 0; p < Parameter::count; ++p) {
    columns.push_back({parameter_names[p], parameter_units[p], {}});
    for (const SetTests& one : sets) columns.back().values.push_back(one.set[p]);
  }
  for (std::size_t o = 0; o < Observable::count; ++o) {
    io::TableColumn mean{observable_names[o], unit_of(o), {}},
        deviation{fmt::format("{}_deviation", observable_names[o]), unit_of(o), {}};
    for (const SetTests& one : sets) {
      mean.values.push_back(one.mean[o]);
      deviation.values.push_back(one.deviation[o]);
    }
    columns.push_back(mean);
    columns.push_back(deviation);
  }
  for (const bool highest : {false, true}) {
    columns.push_back({highest ? "contraction_highest_pressure" : "contraction_lowest_pressure", "-", {}});
    for (const SetTests& one : sets) {
      columns.back().values.push_back(one.contraction.empty() ? 0.0
                                      : highest               ? one.contraction.back()
                                                              : one.contraction.front());
    }
  }
  return columns;
}

/// The search so far.
struct Search {
  std::vector<SetTests> sets;
  std::vector<double> rounds;

  void add(std::vector<SetTests> more, int round, const CalibrateCase& targets) {
    for (SetTests& one : more) {
      print(fmt::format("round {}", round).c_str(), one, targets);
      one.curves.clear();  // the results are kept; the curves of hundreds of tests would only take memory
      rounds.push_back(round);
      sets.push_back(std::move(one));
    }
    std::fflush(stdout);
  }

  [[nodiscard]] std::vector<Measured> usable() const {
    std::vector<Measured> out;
    for (const SetTests& one : sets) {
      if (one.usable()) out.push_back({one.set, one.mean});
    }
    return out;
  }
};

/// The program of the tests that confirm the optimum.
TestProgram confirmation(TestProgram program, const CalibrateCase& targets) {
  program.packing.grains = targets.confirm_grains;
  program.packing.seeds = targets.confirm_seeds;
  program.biaxial.inertial_number = targets.confirm_inertial_number;
  return program;
}

void print_fit(const SetTests& fit, const CalibrateCase& targets) {
  if (!fit.usable()) return;
  const std::array<CalibrationTarget, 3> wanted{targets.peak, targets.critical, targets.dilatancy};
  const std::array<const char*, 3> names{"phi_p", "phi_cs", "psi_max"};
  const double n = std::sqrt(static_cast<double>(fit.held_seeds.size()));
  for (std::size_t o = 0; o < wanted.size(); ++o) {
    std::printf("  %-8s wanted %5.1f deg, is %5.1f +- %.1f deg (standard error of %zu packings): off by %+.1f deg\n",
                names[o], wanted[o].value / degree, fit.mean[o] / degree, fit.deviation[o] / n / degree,
                fit.held_seeds.size(), (fit.mean[o] - wanted[o].value) / degree);
  }
  const double strain = fit.mean[Observable::peak_strain];
  const bool within = strain >= targets.peak_strain_minimum && strain <= targets.peak_strain_maximum;
  std::printf("  peak at %.1f +- %.1f %% of axial strain (wanted %.0f to %.0f %%: %s); contraction %s with pressure\n",
              strain * 100, fit.deviation[Observable::peak_strain] / n * 100, targets.peak_strain_minimum * 100,
              targets.peak_strain_maximum * 100, within ? "met" : "missed",
              fit.contraction_grows() ? "grows" : "does not grow");
}

void print_sensitivity(const Optimum& optimum, const SearchBox& box) {
  for (std::size_t d = 0; d < box.dimensions(); ++d) {
    const Observation& s = optimum.per_doubling[box.parameter(d)];
    std::printf("  %s doubled: phi_p %+.1f  phi_cs %+.1f  psi_max %+.1f deg  peak strain %+.1f %%\n",
                parameter_names[box.parameter(d)], s[0] / degree, s[1] / degree, s[2] / degree, s[3] * 100);
  }
  std::printf(
      "  the sets near the optimum differ from the response surface by %.1f deg in phi_p, %.1f deg in phi_cs, %.1f deg "
      "in "
      "psi_max and %.1f %% in the peak strain (root mean square)\n",
      optimum.scatter[0] / degree, optimum.scatter[1] / degree, optimum.scatter[2] / degree, optimum.scatter[3] * 100);
}

std::vector<io::TableColumn> sensitivity_table(const Optimum& optimum) {
  std::vector<io::TableColumn> columns;
  for (std::size_t o = 0; o < Observable::count; ++o) {
    columns.push_back({observable_names[o], unit_of(o), {}});
    for (const Observation& row : optimum.per_doubling) columns.back().values.push_back(row[o]);
  }
  return columns;
}

/// A table with one row for each test of the confirmation.
std::vector<io::TableColumn> test_table(const std::vector<SetTests>& sets) {
  std::vector<io::TableColumn> c{{"set", "-", {}},
                                 {"seed", "-", {}},
                                 {"pressure", "Pa", {}},
                                 {"peak_angle", "rad", {}},
                                 {"peak_strain", "-", {}},
                                 {"critical_angle", "rad", {}},
                                 {"dilatancy_angle", "rad", {}},
                                 {"contraction", "-", {}},
                                 {"lateral_error", "-", {}},
                                 {"inertial_number", "-", {}},
                                 {"mean_overlap", "-", {}}};
  for (std::size_t k = 0; k < sets.size(); ++k) {
    for (std::size_t t = 0; t < sets[k].curves.size(); ++t) {
      const BiaxialCurve& curve = sets[k].curves[t];
      const Strength& s = sets[k].strengths[t];
      const double row[] = {static_cast<double>(k),
                            static_cast<double>(curve.seed),
                            curve.pressure,
                            s.peak_angle,
                            s.peak_strain,
                            s.critical_angle,
                            s.dilatancy,
                            s.contraction,
                            s.lateral_error,
                            curve.inertial_number,
                            curve.mean_overlap};
      for (std::size_t i = 0; i < c.size(); ++i) c[i].values.push_back(row[i]);
    }
  }
  return c;
}

}  // namespace

Outcome run_calibrate(const Case& input, const RunOptions& options) {
  const PackingNote note = [](const std::string& line) { std::printf("%s\n", line.c_str()); };
  say_remarks(input);
  const CalibrateCase& targets = input.calibrate;
  const TestProgram program{input.soil, input.packing, input.engine, input.biaxial};
  const SearchBox box(targets, program.soil);
  make_folder(options);
  confirm_lock(options, note);
  auto writer = io::ResultWriter::create(options.folder, provenance_of(options, input, "calibrate"), {});
  Search search;
  std::vector<ParameterSet> next = box.grid();
  Optimum optimum;
  for (int round = 0; round <= targets.rounds; ++round) {
    search.add(test_sets(program, next, note), round, targets);
    confirm_lock(options, note);
    writer.set_table("search", table_of(search.sets, search.rounds, targets));
    const std::vector<Measured> usable = search.usable();
    if (usable.empty()) {
      std::fprintf(stderr, "calibrate: no set of the grid could be tested\n");
      return Outcome::no_equilibrium;
    }
    optimum = find_optimum(box, usable, targets, round);
    next = around(box, optimum.set, round + 1);
  }
  const std::vector<ParameterSet> last{optimum.set, parameters_of(program.soil)};
  const std::vector<SetTests> confirmed = test_sets(confirmation(program, targets), last, note);
  confirm_lock(options, note);
  writer.set_table("fit", table_of(confirmed, {0, 1}, targets));
  writer.set_table("tests", test_table(confirmed));
  writer.set_table("sensitivity", sensitivity_table(optimum));
  print("fit", confirmed[0], targets);
  print_fit(confirmed[0], targets);
  print_sensitivity(optimum, box);
  print("as given", confirmed[1], targets);
  return confirmed[0].usable() ? Outcome::done : Outcome::no_equilibrium;
}

}  // namespace voussoir::host
