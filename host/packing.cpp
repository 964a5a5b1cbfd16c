#include "host/packing.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <stdexcept>

#include "io/hash.hpp"
#include "io/packing_file.hpp"

namespace voussoir::host {

namespace {

constexpr double oedometric_end = 700.0e3;       ///< [Pa], the deepest ground of the study
constexpr double oedometric_increment = 1.0e-3;  ///< axial strain [-]
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

std::vector<OedometricPoint> oedometric_test(const PackedRve& rve, double stress) {
  kernels::RveBatch batch = kernels::make_batch({rve.packing}, {0});
  store_rve(rve, batch.committed, 0);
  const kernels::EngineSettings settings{.precision = kernels::Precision::float64};
  std::vector<kernels::RveReport> report(1);
  std::vector<OedometricPoint> points;
  while (points.empty() || points.back().stress_yy < stress) {
    // Half the increment while the packing is soft, so that its small-stress branch has points.
    const double strain = points.size() < 4 ? 0.25 * oedometric_increment : oedometric_increment;
    const std::vector<kernels::StrainRequest> request{
        {.f_rel = {1, 0, 0, std::exp(-strain)}, .strain_steps = 1000, .hold_cap = 2000}};
    kernels::advance(batch, std::span<const kernels::StrainRequest>(request), settings, report);
    if (kernels::is_failure(report[0].status) || points.size() > 200) {
      throw std::runtime_error(fmt::format("oedometric test of seed {} ended as {}", rve.seed, kernels::name_of(report[0].status)));
    }
    kernels::commit(batch);
    const double* s = report[0].stress;
    points.push_back({(points.empty() ? 0.0 : points.back().strain) + strain, -s[3], -s[0], -0.5 * (s[1] + s[2])});
  }
  return points;
}

PackedRve obtain_packing(const Case& input, std::int64_t seed, const PackingNote& note) {
  const std::string recipe = recipe_text(input.soil, input.packing, seed);
  const std::string fingerprint = io::fingerprint_of(recipe);
  if (const auto found = io::find_packing(input.packing.folder, fingerprint)) {
    PackedRve rve = from_file(*found, input.soil);
    if (note) note("packing found: " + table_line(rve));
    return rve;
  }
  PackedRve rve = make_packing(input.soil, input.packing, seed);
  rve.bias = bias_of(oedometric_test(rve, oedometric_end));
  std::filesystem::create_directories(input.packing.folder);
  io::save_packing(io::packing_path(input.packing.folder, fingerprint), to_file(rve, recipe, fingerprint));
  if (note) note("packing made:  " + table_line(rve));
  return rve;
}

PackedRve choose_packing(const Case& input, const PackingNote& note) {
  PackedRve best = obtain_packing(input, input.packing.seed, note);
  for (int k = 1; k < input.packing.candidates; ++k) {
    PackedRve other = obtain_packing(input, input.packing.seed + k, note);
    if (other.bias < best.bias) best = std::move(other);
  }
  if (note) note(fmt::format("packing of seed {} is used: largest |tau_xy|/sigma_yy in oedometric compression {:.4f}", best.seed, best.bias));
  return best;
}

}  // namespace voussoir::host
