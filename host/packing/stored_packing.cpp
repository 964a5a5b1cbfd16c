#include "host/packing/stored_packing.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <cmath>
#include <limits>
#include <utility>

#include "host/case/made_with.hpp"

namespace voussoir::host {

namespace {
/// The history names of the engine's law. A packing with other names belongs to another law and is not read.
std::vector<std::string> history_names() {
  constexpr auto& names = kernels::PlainEngineLaw::history_names;
  return {names.begin(), names.end()};
}
}  // namespace

io::Packing stored_packing(const PackedRve& rve, const SoilCase& soil, const std::string& recipe,
                           const std::string& fingerprint) {
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
  file.history_names = history_names();
  file.history = rve.contact_history;
  file.numbers = {{"void_ratio", rve.void_ratio},
                  {"pressure", rve.pressure},
                  {"coordination", rve.coordination},
                  {"unbalanced_ratio", rve.unbalanced},
                  {"mean_overlap", rve.mean_overlap},
                  {"consolidation_friction", rve.consolidation_friction},
                  {"consolidation_rolling", rve.consolidation_rolling ? 1.0 : 0.0},
                  {"bias", rve.bias},
                  {"seed", static_cast<double>(rve.seed)}};
  file.labels = {{"recipe", recipe}, {"recipe_fingerprint", fingerprint}};
  SoilCase made = soil;
  made.thickness = rve.packing.thickness;  // a packing of another code has its own
  for (const auto& [key, text] : soil_keys(made)) file.labels[key] = text;
  return file;
}

PackedRve grains_from(const io::Packing& file, const SoilCase& soil) {
  PackedRve rve;
  rve.packing = packing_of(soil, file.radius, file.thickness);
  for (std::size_t i = 0; i < file.grains(); ++i) {
    rve.position.push_back(file.x[i]);
    rve.position.push_back(file.y[i]);
  }
  rve.rotation = file.rotation;
  rve.cell = {file.cell[0], file.cell[1], file.cell[2], file.cell[3]};
  return rve;
}

std::string fault_of_state(const io::Packing& file) {
  if (file.history_names != history_names()) {
    return fmt::format("it has the histories [{}] of another contact law, where this program's law has [{}]",
                       fmt::join(file.history_names, ", "), fmt::join(history_names(), ", "));
  }
  for (const char* name : {"seed", "void_ratio", "pressure", "coordination", "unbalanced_ratio"}) {
    const auto found = file.numbers.find(name);
    if (found == file.numbers.end()) return fmt::format("it lacks the number {}", name);
    if (!(std::abs(found->second) < 1e16)) return fmt::format("its {} is {:g}", name, found->second);
  }
  if (!(file.cell[0] * file.cell[3] - file.cell[1] * file.cell[2] > 0)) return "its cell has no positive area";
  for (std::size_t c = 0; c < file.contacts(); ++c) {
    const auto i = file.contact_i[c], j = file.contact_j[c];
    if (i >= j) return fmt::format("its contact {} joins the grains {} and {}, which must ascend", c, i, j);
    if (c > 0 && std::pair(i, j) <= std::pair(file.contact_i[c - 1], file.contact_j[c - 1]))
      return fmt::format("its contacts {} and {} are out of order", c - 1, c);
  }
  for (std::size_t k = 0; k < file.history.size(); ++k) {
    if (!std::isfinite(file.history[k]))
      return fmt::format("the history of its contact {} is not finite", k / history_names().size());
  }
  return "";
}

std::optional<PackedRve> restored_packing(const io::Packing& file, const SoilCase& soil) {
  if (!fault_of_state(file).empty()) return {};
  const auto number = [&](const char* name) {
    const auto found = file.numbers.find(name);
    return found == file.numbers.end() ? std::numeric_limits<double>::quiet_NaN() : found->second;
  };
  PackedRve rve = grains_from(file, soil);
  rve.contact_history = file.history;
  for (std::size_t c = 0; c < file.contacts(); ++c) {
    rve.contact_key.push_back(
        kernels::pair_key(static_cast<int>(file.contact_i[c]), static_cast<int>(file.contact_j[c])));
  }
  rve.void_ratio = number("void_ratio");
  rve.pressure = number("pressure");
  rve.coordination = number("coordination");
  rve.unbalanced = number("unbalanced_ratio");
  rve.bias = number("bias");
  // Files of older versions lack it.
  if (file.numbers.contains("mean_overlap")) rve.mean_overlap = number("mean_overlap");
  rve.consolidation_friction = number("consolidation_friction");
  // Files of older versions lack it: their grains resisted rolling.
  rve.consolidation_rolling = !(number("consolidation_rolling") == 0.0);
  rve.seed = static_cast<std::int64_t>(number("seed"));
  return rve;
}

}  // namespace voussoir::host
