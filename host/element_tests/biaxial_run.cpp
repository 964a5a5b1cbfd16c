#include "host/element_tests/biaxial_run.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <optional>

#include "host/case/engine.hpp"
#include "host/case/result_fields.hpp"
#include "host/element_tests/biaxial.hpp"
#include "host/element_tests/strength.hpp"
#include "host/packing/law_range.hpp"
#include "host/packing/packings.hpp"
#include "host/process/exit_code.hpp"
#include "host/record/provenance.hpp"
#include "host/record/remarks.hpp"
#include "io/result_file.hpp"

namespace voussoir::host {

namespace {

constexpr double degree = std::numbers::pi / 180.0;

template <class Value>
io::TableColumn column(const char* name, const char* unit, const std::vector<BiaxialPoint>& points,
                       const Value& value) {
  io::TableColumn out{name, unit, {}};
  for (const BiaxialPoint& point : points) out.values.push_back(value(point));
  return out;
}

/// Adds columns of the contact network: those that every RVE of a mesh has, and those that the case asks for.
void add_microstructure(const BiaxialCurve& curve, const kernels::MicrostructureRequest& wanted,
                        std::vector<io::TableColumn>& table) {
  if (!wanted.any()) return;
  for (const ResultField& field : result_field_table) {
    if (field.of_network == nullptr || !is_asked_for(field, wanted)) continue;
    table.push_back(column(field.name, field.unit, curve.points,
                           [&](const BiaxialPoint& x) { return field.of_network(x.microstructure); }));
  }
}

std::vector<io::TableColumn> curve_table(const BiaxialCurve& curve, const kernels::MicrostructureRequest& wanted) {
  const auto& points = curve.points;
  std::vector<io::TableColumn> table{
      column("axial_strain", "-", points, [](const BiaxialPoint& x) { return x.axial_strain; }),
      column("lateral_strain", "-", points, [](const BiaxialPoint& x) { return x.lateral_strain; }),
      column("volumetric_strain", "-", points, [](const BiaxialPoint& x) { return x.volumetric_strain(); }),
      column("stress_xx", "Pa", points, [](const BiaxialPoint& x) { return x.stress_xx; }),
      column("stress_yy", "Pa", points, [](const BiaxialPoint& x) { return x.stress_yy; }),
      column("stress_xy", "Pa", points, [](const BiaxialPoint& x) { return x.stress_xy; }),
      column("p", "Pa", points, [](const BiaxialPoint& x) { return x.p(); }),
      column("q", "Pa", points, [](const BiaxialPoint& x) { return x.q(); }),
      column("void_ratio", "-", points, [&](const BiaxialPoint& x) { return curve.void_ratio_at(x); }),
      column("unbalanced_ratio", "-", points, [](const BiaxialPoint& x) { return x.unbalanced; })};
  add_microstructure(curve, wanted, table);
  return table;
}

/// All tests of a case: every seed at every pressure, each packing consolidated at its test's pressure. A pressure at
/// which no packing comes to rest is noted and left out. Throws NoEquilibrium where no pressure has a packing.
std::vector<PackedRve> packings_of(const SoilCase& soil, PackingCase recipe, std::span<const double> pressures,
                                   const PackingNote& note) {
  std::vector<PackedRve> all;
  for (const double pressure : pressures) {
    recipe.pressure = pressure;
    try {
      for (PackedRve& rve : obtain_packings(soil, recipe, seeds_of(recipe), note, Bias::left))
        all.push_back(std::move(rve));
    } catch (const NoEquilibrium& none) {
      if (pressures.size() == 1) throw;
      note(std::string(none.what()));
    }
  }
  if (all.empty()) throw NoEquilibrium("no packing comes to rest at any of the pressures of biaxial.pressures");
  return all;
}

const char* outcome(const BiaxialCurve& curve, const Strength& s) {
  if (curve.status != kernels::RveStatus::converged) return kernels::name_of(curve.status);
  if (held(curve, s)) return "valid";  // not "converged": a test moves at its rate and never rests
  if (curve.mean_overlap > most_mean_overlap) return "invalid: beyond the contact law's range";
  if (s.lateral_scatter <= most_lateral_scatter && s.late_rise > most_late_rise)
    return "invalid: the strength still rises, biaxial.strain is too small";
  return "sigma_xx not held";
}

void print(const BiaxialCurve& curve, const Strength& s) {
  std::printf(
      "seed %4lld  %7.1f kPa  phi_p %5.1f deg at %4.1f %%  phi_cs %5.1f deg  psi_max %5.1f deg  contraction %.3f %%  "
      "sigma_xx off by %.2f %%, scatters by %.1f %%  I %.1e  overlap %.2f %%  %s\n",
      static_cast<long long>(curve.seed), curve.pressure * 1e-3, s.peak_angle / degree, s.peak_strain * 100.0,
      s.critical_angle / degree, s.dilatancy / degree, s.contraction * 100.0, s.lateral_error * 100.0,
      s.lateral_scatter * 100.0, curve.inertial_number, curve.mean_overlap * 100.0, outcome(curve, s));
}

struct Summary {
  std::vector<double> seed, pressure, peak, peak_p, peak_strain, critical, critical_p, dilatancy, contraction;
  std::vector<double> lateral, scatter, inertial, overlap, valid;

  void add(const BiaxialCurve& curve, const Strength& s, bool is_valid) {
    seed.push_back(static_cast<double>(curve.seed));
    pressure.push_back(curve.pressure);
    peak.push_back(s.peak_angle);
    peak_p.push_back(mean_stress_at(curve.pressure, s.peak_angle));
    peak_strain.push_back(s.peak_strain);
    critical.push_back(s.critical_angle);
    critical_p.push_back(mean_stress_at(curve.pressure, s.critical_angle));
    dilatancy.push_back(s.dilatancy);
    contraction.push_back(s.contraction);
    lateral.push_back(s.lateral_error);
    scatter.push_back(s.lateral_scatter);
    valid.push_back(is_valid ? 1.0 : 0.0);
    inertial.push_back(curve.inertial_number);
    overlap.push_back(curve.mean_overlap);
  }

  [[nodiscard]] std::vector<io::TableColumn> table() const {
    return {{"seed", "-", seed},
            {"pressure", "Pa", pressure},
            {"peak_angle", "rad", peak},
            {"peak_strain", "-", peak_strain},
            {"critical_angle", "rad", critical},
            {"dilatancy_angle", "rad", dilatancy},
            {"contraction", "-", contraction},
            {"lateral_error", "-", lateral},
            {"lateral_scatter", "-", scatter},
            {"inertial_number", "-", inertial},
            {"mean_overlap", "-", overlap},
            {"valid", "-", valid}};
  }

  /// The values of the tests that were held.
  [[nodiscard]] std::vector<double> of_valid(const std::vector<double>& values) const {
    std::vector<double> out;
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (valid[k] != 0) out.push_back(values[k]);
    }
    return out;
  }
};

/// The angles of all valid tests together, if there are any.
void print_common_angles(const Summary& summary, double window) {
  const std::vector<double> psi = summary.of_valid(summary.dilatancy);
  if (psi.empty()) return;
  const CommonDilatancy dilatancy = common_dilatancy(psi);
  const std::string scatter = psi.size() > 1 ? fmt::format(" +- {:.1f}", dilatancy.deviation / degree) : "";
  const std::string tests = psi.size() > 1 ? fmt::format("the mean of {} tests", psi.size()) : "one test";
  std::printf(
      "all valid tests: phi_p %.1f deg, phi_cs %.1f deg, psi_max %.1f%s deg (%s, smoothed over %.1f %% of axial "
      "strain)\n",
      common_angle(summary.of_valid(summary.peak), summary.of_valid(summary.peak_p)) / degree,
      common_angle(summary.of_valid(summary.critical), summary.of_valid(summary.critical_p)) / degree,
      dilatancy.mean / degree, scatter.c_str(), tests.c_str(), window * 100.0);
}

/// Number of tests that a case asks for; tests whose packing does not come to rest are left out later. A file gives one
/// packing for each pressure.
std::size_t wanted_tests(const PackingCase& recipe, const BiaxialCase& test) {
  return count_of_packings(recipe) * test.pressures.size();
}

/// The outcome of a run by the number of its valid tests; where some are not valid, standard error says how many.
Outcome outcome_of_tests(std::size_t valid, std::size_t wanted) {
  if (valid >= wanted) return Outcome::done;
  std::fprintf(stderr,
               "biaxial: %zu of %zu tests are not valid: they ended early, or did not hold sigma_xx, passed the "
               "contact law's range, or have no packing at rest (column `valid` of the table `strength`)\n",
               wanted - valid, wanted);
  return Outcome::no_equilibrium;
}

/// Outcome of a finished run, from the tests in its folder; nothing where there is no finished run.
std::optional<Outcome> finished_before(std::size_t wanted, const RunOptions& options) {
  const std::filesystem::path file = options.folder / "run.h5";
  if (!options.resume || !std::filesystem::exists(file)) return {};
  const io::Tables tables = io::read_tables(file);
  const auto strength = tables.find("strength");  // written last
  if (strength == tables.end()) return {};
  for (const io::TableColumn& column : strength->second) {
    if (column.name != "valid") continue;
    return outcome_of_tests(static_cast<std::size_t>(std::count(column.values.begin(), column.values.end(), 1.0)),
                            wanted);
  }
  return {};
}

}  // namespace

Outcome run_biaxial(const Case& input, const RunOptions& options) {
  const BiaxialCase& test = input.biaxial;
  const std::size_t wanted = wanted_tests(input.packing, test);
  if (const std::optional<Outcome> before = finished_before(wanted, options)) {
    std::printf("the run in %s is finished already, there is nothing to do\n", options.folder.string().c_str());
    return *before;
  }
  if (options.resume) std::printf("biaxial tests run all at once and have no checkpoint: they begin anew\n");
  say_remarks(input);
  const PackingNote note = [](const std::string& line) { std::printf("%s\n", line.c_str()); };
  const std::vector<PackedRve> rves = packings_of(input.soil, input.packing, test.pressures, note);
  const auto curves = biaxial_tests(rves, test.strain, test.inertial_number, test.samples,
                                    engine_settings(input.engine), input.output.microstructure);
  make_folder(options);
  confirm_lock(options, note);
  auto writer = io::ResultWriter::create(options.folder, provenance_of(options, input, "biaxial"), {});
  Summary summary;
  std::size_t valid = 0;
  for (const BiaxialCurve& curve : curves) {
    const Strength s = strength_of(curve, test.window);
    print(curve, s);
    summary.add(curve, s, held(curve, s));
    valid += held(curve, s) ? 1 : 0;
    writer.set_table(fmt::format("seed_{}_{:.4g}_kPa", curve.seed, curve.pressure * 1e-3),
                     curve_table(curve, input.output.microstructure));
  }
  writer.set_table("strength", summary.table());
  print_common_angles(summary, test.window);
  const auto beyond = std::count_if(curves.begin(), curves.end(),
                                    [](const BiaxialCurve& curve) { return curve.mean_overlap > most_mean_overlap; });
  if (beyond > 0) {
    std::fprintf(
        stderr,
        "biaxial: %td of %zu tests are invalid because the mean overlap of their contacts passed %.0f %% of r_i + "
        "r_j, beyond which the contact law is not good for strengths (docs/explanation/range.md)\n",
        beyond, curves.size(), most_mean_overlap * 100.0);
  }
  if (curves.size() < wanted) {
    std::fprintf(stderr, "biaxial: %zu of %zu tests were left out because their packings do not come to rest\n",
                 wanted - curves.size(), wanted);
  }
  return outcome_of_tests(valid, wanted);
}

}  // namespace voussoir::host
