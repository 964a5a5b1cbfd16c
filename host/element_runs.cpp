// The case kinds without a mesh: `pack` and `probe`.

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "host/exit_code.hpp"
#include "host/packing.hpp"
#include "host/rve_pool.hpp"

namespace voussoir::host {

namespace {

const PackingNote print = [](const std::string& line) { std::printf("%s\n", line.c_str()); };

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

}  // namespace

int run_probe(const Case& input, const RunOptions& options) {
  Case at_pressure = input;
  at_pressure.packing.pressure = input.probe.pressure;
  const std::vector<Probe> all = probes(input.probe.strain);
  RvePool pool(choose_packing(at_pressure, print), input.engine, all.size());
  std::vector<fem::Gradient> gradients;
  for (const Probe& probe : all) gradients.push_back(probe.gradient);
  std::vector<fem::Stress> before(all.size()), after(all.size());
  std::vector<fem::Tangent> tangent(all.size()), tangent_after(all.size());
  pool.committed(before, tangent);
  const fem::BatchReport report = pool.evaluate(gradients, after, tangent_after);
  if (!report.usable) {
    std::fprintf(stderr, "probe: %s\n", report.message.c_str());
    return exit_numerical;
  }

  std::filesystem::create_directories(options.folder);
  std::ofstream csv(options.folder / "probe.csv");
  csv << "probe,stress_xx_Pa,stress_yy_Pa,stress_xy_Pa,change_xx_Pa,change_yy_Pa,change_xy_Pa,"
         "tangent_xxxx_Pa,tangent_xxyy_Pa,tangent_xxxy_Pa,tangent_yyyy_Pa,tangent_yyxy_Pa,tangent_xyxy_Pa\n";
  std::printf("%-9s %12s %12s %12s   change of stress over strain [MPa], tension positive\n", "probe", "xx", "yy", "xy");
  for (std::size_t k = 0; k < all.size(); ++k) {
    const fem::Stress change = after[k] - before[k];
    const fem::Tangent& d = tangent[k];
    std::printf("%-9s %12.4f %12.4f %12.4f\n", all[k].name, change(0) / input.probe.strain * 1e-6,
                change(1) / input.probe.strain * 1e-6, change(2) / input.probe.strain * 1e-6);
    csv << fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{}\n", all[k].name, after[k](0), after[k](1), after[k](2), change(0),
                       change(1), change(2), d(0, 0), d(0, 1), d(0, 2), d(1, 1), d(1, 2), d(2, 2));
  }
  const fem::Tangent& d = tangent[0];
  std::printf("tangent of eq. (4) [MPa]: xxxx %.4f xxyy %.4f xxxy %.4f yyyy %.4f yyxy %.4f xyxy %.4f\n", d(0, 0) * 1e-6,
              d(0, 1) * 1e-6, d(0, 2) * 1e-6, d(1, 1) * 1e-6, d(1, 2) * 1e-6, d(2, 2) * 1e-6);
  if (!csv.flush()) throw std::runtime_error((options.folder / "probe.csv").string() + " cannot be written");
  return exit_ok;
}

int run_pack(const Case& input, const RunOptions&) {
  const std::vector<std::int64_t> seeds = seeds_of(input.packing);
  const std::size_t made = obtain_packings(input, seeds, print).size();
  if (made == seeds.size() || !input.packing.file.empty()) return exit_ok;
  std::fprintf(stderr, "pack: %zu of %zu packings do not come to rest\n", seeds.size() - made, seeds.size());
  return exit_numerical;
}

}  // namespace voussoir::host
