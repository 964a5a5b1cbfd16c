#include "host/element_tests/probe.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "host/case/engine.hpp"
#include "host/case/made_with.hpp"
#include "host/element_tests/strain_path.hpp"
#include "host/material/answers.hpp"
#include "host/material/rve_pool.hpp"
#include "host/packing/law_range.hpp"
#include "host/packing/packings.hpp"
#include "host/packing/stored_packing.hpp"
#include "host/record/remarks.hpp"
#include "io/atomic_file.hpp"

namespace voussoir::host {

namespace {

const PackingNote print = [](const std::string& line) { std::printf("%s\n", line.c_str()); };

/// The difference is too small to matter to the stress by itself, and far larger than the rounding of float.
constexpr double replica_difference = 1e-6;

struct Probe {
  const char* name;
  fem::Gradient gradient;
};

std::vector<Probe> probes(double strain) {
  const auto gradient = [](double xx, double xy, double yx, double yy) {
    fem::Gradient g;
    g << xx, xy, yx, yy;
    return g;
  };
  return {{"xx", gradient(strain, 0, 0, 0)},
          {"yy", gradient(0, 0, 0, strain)},
          {"xy", gradient(0, 0.5 * strain, 0.5 * strain, 0)},
          {"rotation", gradient(std::cos(strain) - 1.0, -std::sin(strain), std::sin(strain), std::cos(strain) - 1.0)},
          {"-xx", gradient(-strain, 0, 0, 0)},
          {"-yy", gradient(0, 0, 0, -strain)}};
}

std::vector<double> scales(int replicas) {
  std::vector<double> scale;
  for (int k = 0; k < replicas; ++k) scale.push_back(1.0 + replica_difference * k);
  return scale;
}

/// The rows of the run's tables so far.
struct Tables {
  std::string path =
      "seed,replica,increment,evaluations,strain_xx,strain_yy,strain_xy,stress_xx_Pa,stress_yy_Pa,stress_xy_Pa,void_"
      "ratio,"
      "steps,unbalanced_ratio,inertial_number,mean_overlap,status\n";
  std::string probe =
      "seed,replica,probe,stress_xx_Pa,stress_yy_Pa,stress_xy_Pa,change_xx_Pa,change_yy_Pa,change_xy_Pa,"
      "tangent_xxxx_Pa,tangent_xxyy_Pa,tangent_xxxy_Pa,tangent_yyyy_Pa,tangent_yyxy_Pa,tangent_xyxy_Pa,"
      "tangent_yyxx_Pa,tangent_xyxx_Pa,tangent_xyyy_Pa,tangent,"
      "tangent_after_xxxx_Pa,tangent_after_xxyy_Pa,tangent_after_xxxy_Pa,tangent_after_yyyy_Pa,tangent_after_yyxy_Pa,"
      "tangent_after_xyxy_Pa,tangent_after_yyxx_Pa,tangent_after_xyxx_Pa,tangent_after_xyyy_Pa,tangent_after,"
      "steps,unbalanced_ratio,inertial_number,mean_overlap,status\n";
};

std::string end_of_row(const kernels::RveReport& report) {
  return fmt::format("{},{:.6g},{:.6g},{:.6g},{}\n", report.steps, report.unbalanced, report.inertial_number,
                     report.mean_overlap, kernels::name_of(report.status));
}

std::string cells_of(const kernels::RveReport& report) {
  const fem::Tangent d = whole_tangent_of(report);
  return fmt::format("{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{},", d(0, 0), d(0, 1), d(0, 2),
                     d(1, 1), d(1, 2), d(2, 2), d(1, 0), d(2, 0), d(2, 1), kernels::name_of(report.tangent_kind));
}

void print_probe(const Probe& probe, const fem::Stress& change, double strain) {
  const fem::Stress slope = change / strain * 1e-6;
  std::printf("%-9s %12.4f %12.4f %12.4f\n", probe.name, slope(0), slope(1), slope(2));
}

/// Prints a tangent with the name of the kind that was found. This kind differs from the requested one where the
/// requested tangent was not found.
void print_tangent(const kernels::RveReport& report) {
  const fem::Tangent d = whole_tangent_of(report) * 1e-6;
  std::printf("tangent (%s) [MPa]: xxxx %.4f xxyy %.4f xxxy %.4f yyyy %.4f yyxy %.4f xyxy %.4f",
              kernels::name_of(report.tangent_kind), d(0, 0), d(0, 1), d(0, 2), d(1, 1), d(1, 2), d(2, 2));
  if (report.tangent_kind == kernels::TangentKind::loading)
    std::printf(" yyxx %.4f xyxx %.4f xyyy %.4f", d(1, 0), d(2, 0), d(2, 1));
  std::printf("%s\n", report.tangent_capped ? "; the iterations ended before its tolerance was met" : "");
}

/// The end of a path as a file, with the keys of the soil and of the engine that it was made with.
io::Packing end_of_path(const PackedRve& rve, const Case& input) {
  io::Packing file = stored_packing(rve, input.soil, "path of " + input.name, input.fingerprint);
  for (const auto& [key, text] : engine_keys(input.engine)) file.labels[key] = text;
  return file;
}

/// Says that a packing does not begin at rest, and returns whether it does. Its first row has the status `step_limit`
/// where it does not.
bool begins_at_rest(const PackedRve& rve, const kernels::RveReport& start, const EngineCase& engine) {
  if (start.status != kernels::RveStatus::step_limit) return true;
  std::fprintf(
      stderr,
      "probe: seed %lld does not begin at rest: its unbalanced ratio is %.2g, and engine.hold_tolerance is %.2g\n",
      static_cast<long long>(rve.seed), start.unbalanced, engine.hold_tolerance);
  return false;
}

/// Counts what the rows of a path or of probes are not: at rest, and within the contact law's range.
struct Doubts {
  int rows = 0, restless = 0, beyond = 0;

  void see(const kernels::RveReport& report) {
    ++rows;
    if (report.status == kernels::RveStatus::step_limit) ++restless;
    if (report.mean_overlap > most_mean_overlap) ++beyond;
  }
  void say(const PackedRve& rve, const char* what) const {
    if (restless > 0) {
      std::fprintf(stderr, "probe: seed %lld: %d of %d %s ended at the step limit, not at rest\n",
                   static_cast<long long>(rve.seed), restless, rows, what);
    }
    if (beyond > 0) {
      std::fprintf(
          stderr,
          "probe: seed %lld: %d of %d %s have a mean overlap above %.0f %% of r_i + r_j, beyond which the contact "
          "law is not good (docs/explanation/range.md)\n",
          static_cast<long long>(rve.seed), beyond, rows, what, most_mean_overlap * 100.0);
    }
  }
};

/// What became of a path or of the probes of one packing.
struct Verdict {
  std::string failure = {};  ///< a sentence; empty where all rows were computed
  bool at_rest = true;       ///< of the start and of all rows; a test that does not rest is not valid
};

/// Takes the path and stores its end in `rve`.
Verdict take_path(const ProbeCase& probe, const EngineCase& engine, PackedRve& rve, Tables& tables) {
  const std::vector<double> scale = scales(probe.replicas);
  RvePool pool(rve, {engine}, scale.size());
  const bool begins = begins_at_rest(rve, pool.committed_reports().front(), engine);
  Doubts doubts;
  const PathEnd end = walk_path(pool, probe.path, scale, [&](const PathPoint& at) {
    tables.path += fmt::format("{},{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},", rve.seed, at.rve,
                               at.increment, at.evaluations, at.strain.xx, at.strain.yy,
                               0.5 * (at.strain.xy + at.strain.yx), at.stress(0), at.stress(1), at.stress(2),
                               at.void_ratio) +
                   end_of_row(*at.report);
    if (at.increment > 0) doubts.see(*at.report);
  });
  doubts.say(rve, "rows of the path");
  if (end.missed > 0) {
    const std::string said = fmt::format(
        "seed {}: {} increments of the path did not hold sigma_xx, which was off by up to {:.2g} % of its value; "
        "smaller "
        "increments hold it better",
        rve.seed, end.missed, end.largest_miss * 100);
    std::fprintf(stderr, "probe: %s\n", said.c_str());
  }
  if (!end.usable) return {.failure = fmt::format("seed {}, {}", rve.seed, end.message), .at_rest = false};
  PackedRve last = pool.packed(0);
  last.seed = rve.seed;
  last.consolidation_friction = rve.consolidation_friction;
  rve = std::move(last);
  return {.at_rest = begins && doubts.restless == 0};
}

/// Makes all probes of all replicas from the state `rve`.
Verdict take_probes(const ProbeCase& wanted, const EngineCase& engine, const PackedRve& rve, Tables& tables,
                    bool show) {
  const std::vector<Probe> all = probes(wanted.strain);
  const std::vector<double> scale = scales(wanted.replicas);
  const std::size_t n = all.size() * scale.size();
  RvePool pool(rve, {.engine = engine, .tangent = tangent_kind(wanted.tangent), .tangent_strain = wanted.strain}, n);
  std::vector<fem::Gradient> gradients;
  for (const double factor : scale) {
    for (const Probe& probe : all) gradients.emplace_back(factor * probe.gradient);
  }
  std::vector<fem::Stress> before(n), after(n);
  std::vector<fem::Tangent> unused(n);
  pool.committed(before, unused);
  const kernels::RveReport start = pool.committed_reports().front();
  const bool begins = !wanted.path.empty() || begins_at_rest(rve, start, engine);
  const fem::BatchReport report = pool.evaluate(gradients, after, unused);
  pool.commit();
  if (show)
    std::printf("%-9s %12s %12s %12s   change of stress over strain [MPa], tension positive\n", "probe", "xx", "yy",
                "xy");
  Doubts doubts;
  for (std::size_t k = 0; k < n; ++k) {
    const Probe& probe = all[k % all.size()];
    const fem::Stress change = after[k] - before[k];
    if (show && k < all.size()) print_probe(probe, change, wanted.strain);
    tables.probe += fmt::format("{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},", rve.seed, k / all.size(),
                                probe.name, after[k](0), after[k](1), after[k](2), change(0), change(1), change(2)) +
                    cells_of(start) + cells_of(pool.committed_reports()[k]) + end_of_row(pool.committed_reports()[k]);
    doubts.see(pool.committed_reports()[k]);
  }
  doubts.say(rve, "probes");
  if (show) print_tangent(start);
  return {.failure = report.usable ? "" : fmt::format("seed {}, {}", rve.seed, report.message),
          .at_rest = begins && doubts.restless == 0};
}

/// The packings that are probed. Where there are several, all are used, so that no bias has to be measured to choose.
std::vector<PackedRve> packings_to_probe(const SoilCase& soil, PackingCase recipe, double pressure) {
  recipe.pressure = pressure;
  if (recipe.seeds.empty() || !recipe.files.empty()) return {choose_packing(soil, recipe, print)};
  std::vector<PackedRve> rves;
  for (const std::int64_t seed : recipe.seeds)
    rves.push_back(obtain_packings(soil, recipe, std::span(&seed, 1), print).front());
  return rves;
}

}  // namespace

Outcome run_probe(const Case& input, const RunOptions& options) {
  std::printf("%s\n", engine_note(input.engine, input.soil).c_str());
  say_remarks(input);
  std::vector<PackedRve> rves = packings_to_probe(input.soil, input.packing, input.probe.pressure);
  make_folder(options);
  io::remove_leftovers(options.folder);
  confirm_lock(options, print);
  Tables tables;
  Outcome outcome = Outcome::done;
  const auto has_failed = [&outcome](const Verdict& verdict) {
    if (!verdict.failure.empty()) std::fprintf(stderr, "probe: %s\n", verdict.failure.c_str());
    if (!verdict.failure.empty() || !verdict.at_rest) outcome = Outcome::no_equilibrium;
    return !verdict.failure.empty();
  };
  for (PackedRve& rve : rves) {
    if (!input.probe.path.empty()) {
      if (has_failed(take_path(input.probe, input.engine, rve, tables))) continue;
      confirm_lock(options, print);
      io::save_packing(options.folder / fmt::format("end_{}.h5", rve.seed), end_of_path(rve, input));
    }
    static_cast<void>(has_failed(take_probes(input.probe, input.engine, rve, tables, &rve == &rves.front())));
  }
  confirm_lock(options, print);
  if (!input.probe.path.empty()) io::write_text(options.folder / "path.csv", tables.path);
  io::write_text(options.folder / "probe.csv", tables.probe);
  return outcome;
}

}  // namespace voussoir::host
