#include "host/packing.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "io/hash.hpp"
#include "io/packing_file.hpp"

namespace voussoir::host {

namespace {

constexpr double oedometric_end = 700.0e3;       ///< [Pa], the deepest ground of the study
constexpr double oedometric_increment = 1.0e-3;  ///< axial strain [-]
constexpr int most_increments = 200;
constexpr double bias_floor = 20.0e3;            ///< below it tau_xy is what consolidation left [Pa]

io::Packing to_file(const PackedRve& rve, const std::string& recipe, const std::string& fingerprint) {
  io::Packing file;
  file.radius = rve.packing.radii;
  for (std::size_t i = 0; i < rve.packing.radii.size(); ++i) {
    file.x.push_back(rve.position[2 * i]);
    file.y.push_back(rve.position[2 * i + 1]);
  }
  file.rotation = rve.rotation;
  file.cell = {rve.cell.xx, rve.cell.xy, rve.cell.yx, rve.cell.yy};
  file.thickness = rve.packing.thickness;
  for (const std::uint32_t key : rve.contact_key) {
    file.contact_i.push_back(kernels::first_of(key));
    file.contact_j.push_back(kernels::second_of(key));
  }
  file.history_names = {"tangential_force", "rolling_moment"};
  file.history = rve.contact_history;
  file.numbers = {{"void_ratio", rve.void_ratio},     {"pressure", rve.pressure}, {"coordination", rve.coordination},
                  {"unbalanced_ratio", rve.unbalanced}, {"bias", rve.bias},         {"seed", static_cast<double>(rve.seed)}};
  file.labels = {{"recipe", recipe}, {"recipe_fingerprint", fingerprint}};
  return file;
}

PackedRve from_file(const io::Packing& file, const SoilCase& soil) {
  PackedRve rve;
  rve.packing = {.radii = file.radius,
                 .material = grain_material(soil),
                 .thickness = file.thickness,
                 .local_damping = soil.damping};
  for (std::size_t i = 0; i < file.grains(); ++i) {
    rve.position.push_back(file.x[i]);
    rve.position.push_back(file.y[i]);
  }
  rve.rotation = file.rotation;
  rve.cell = {file.cell[0], file.cell[1], file.cell[2], file.cell[3]};
  for (std::size_t c = 0; c < file.contacts(); ++c) {
    rve.contact_key.push_back(kernels::pair_key(static_cast<int>(file.contact_i[c]), static_cast<int>(file.contact_j[c])));
  }
  rve.contact_history = file.history;
  rve.seed = static_cast<std::int64_t>(file.numbers.at("seed"));
  rve.void_ratio = file.numbers.at("void_ratio");
  rve.pressure = file.numbers.at("pressure");
  rve.coordination = file.numbers.at("coordination");
  rve.unbalanced = file.numbers.at("unbalanced_ratio");
  rve.bias = file.numbers.at("bias");
  return rve;
}

double bias_of(const std::vector<OedometricPoint>& test) {
  double bias = 0;
  for (const OedometricPoint& point : test) {
    if (point.stress_yy >= bias_floor) bias = std::max(bias, std::abs(point.stress_xy) / point.stress_yy);
  }
  return bias;
}

std::string table_line(const PackedRve& rve) {
  return fmt::format("seed {:5d}  grains {:5d}  void ratio {:.4f}  p {:.1f} Pa  coordination {:.3f}  unbalanced {:.1e}  bias {:.4f}",
                     rve.seed, rve.packing.size(), rve.void_ratio, rve.pressure, rve.coordination, rve.unbalanced, rve.bias);
}

}  // namespace

std::vector<std::vector<OedometricPoint>> oedometric_tests(std::span<const PackedRve> rves, double stress) {
  kernels::RveBatch batch = batch_of(rves);
  const kernels::EngineSettings settings{.precision = kernels::Precision::float64};
  std::vector<kernels::RveReport> reports(rves.size());
  std::vector<std::vector<OedometricPoint>> curves(rves.size());
  const auto reached = [&](const auto& curve) { return !curve.empty() && curve.back().stress_yy >= stress; };
  double total = 0;
  for (int increment = 0; !std::all_of(curves.begin(), curves.end(), reached); ++increment) {
    if (increment == most_increments) throw std::runtime_error("the oedometric test does not reach its stress");
    const double strain = increment < 4 ? 0.25 * oedometric_increment : oedometric_increment;  // fine while it is soft
    const std::vector<kernels::StrainRequest> requests(
        rves.size(), {.f_rel = {1, 0, 0, std::exp(-strain)}, .strain_steps = 1000, .hold_cap = 2000});
    kernels::advance(batch, std::span<const kernels::StrainRequest>(requests), settings, reports);
    kernels::commit(batch);
    total += strain;
    for (std::size_t k = 0; k < rves.size(); ++k) {
      if (kernels::is_failure(reports[k].status)) {
        throw std::runtime_error(fmt::format("oedometric test of seed {} ended as {}", rves[k].seed,
                                             kernels::name_of(reports[k].status)));
      }
      const double* s = reports[k].stress;
      curves[k].push_back({total, -s[3], -s[0], -0.5 * (s[1] + s[2])});
    }
  }
  return curves;
}

std::vector<std::int64_t> seeds_of(const PackingCase& packing) {
  std::vector<std::int64_t> seeds = packing.seeds;
  for (int k = 0; packing.seeds.empty() && k < packing.candidates; ++k) seeds.push_back(packing.seed + k);
  return seeds;
}

std::vector<PackedRve> obtain_packings(const Case& input, std::span<const std::int64_t> seeds, const PackingNote& note) {
  std::vector<PackedRve> out;
  std::vector<std::int64_t> missing;
  for (const std::int64_t seed : seeds) {
    const auto found = io::find_packing(input.packing.folder, io::fingerprint_of(recipe_text(input.soil, input.packing, seed)));
    if (!found) {
      missing.push_back(seed);
      continue;
    }
    out.push_back(from_file(*found, input.soil));
    if (note) note("packing found: " + table_line(out.back()));
  }
  std::vector<PackedRve> made = make_packings(input.soil, input.packing, missing);
  const auto curves = oedometric_tests(made, oedometric_end);
  for (std::size_t k = 0; k < made.size(); ++k) {
    made[k].bias = bias_of(curves[k]);
    const std::string recipe = recipe_text(input.soil, input.packing, made[k].seed);
    const std::string fingerprint = io::fingerprint_of(recipe);
    std::filesystem::create_directories(input.packing.folder);
    io::save_packing(io::packing_path(input.packing.folder, fingerprint), to_file(made[k], recipe, fingerprint));
    if (note) note("packing made:  " + table_line(made[k]));
    out.push_back(std::move(made[k]));
  }
  return out;
}

PackedRve choose_packing(const Case& input, const PackingNote& note) {
  std::vector<PackedRve> all = obtain_packings(input, seeds_of(input.packing), note);
  const auto less_biased = [](const PackedRve& a, const PackedRve& b) {
    return a.bias != b.bias ? a.bias < b.bias : a.seed < b.seed;
  };
  PackedRve best = *std::min_element(all.begin(), all.end(), less_biased);
  if (note) {
    note(fmt::format("packing of seed {} is used: largest |tau_xy|/sigma_yy in oedometric compression {:.4f}", best.seed, best.bias));
  }
  return best;
}

}  // namespace voussoir::host
