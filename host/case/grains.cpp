#include "host/case/grains.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "host/case/keys.hpp"
#include "io/packing_file.hpp"
#include "io/units.hpp"

namespace voussoir::host {

using io::Dimension;

namespace {

// Limits that [soil] and its classes share. Within them the engine's numbers stay far from the ends of what a float can
// hold, and a run ends with an answer or says why it has none; tests/regression/key_limits_test.py tries all of them.
const io::QuantityRule size_rule{.at_least = "0.001 mm", .at_most = "1 m"};
const io::QuantityRule modulus_rule{.at_least = "1 MPa", .at_most = "1000 GPa"};
const io::QuantityRule stiffness_ratio_rule{.at_least = "0", .at_most = "2"};
const io::QuantityRule friction_rule{.at_least = "0 deg", .at_most = "80 deg"};
const io::QuantityRule rolling_rule{.at_least = "0", .at_most = "10"};  ///< of rolling_stiffness and rolling_limit

/// Seeds are stored as float64 with the packings, and derived ones are larger by up to a million.
constexpr std::int64_t largest_seed = 9'000'000'000'000'000;
constexpr std::size_t most_seeds = 1000;
constexpr std::int64_t most_variety = 1000;

/// Reads `sizes` and `passing`, a grading curve, which also sets the smallest and the largest size.
void read_grading(const io::Table& table, SoilCase& soil) {
  soil.sizes = table.quantities("sizes", Dimension::length, size_rule, std::vector<std::string>{});
  soil.passing = table.quantities("passing", Dimension::none, {.at_least = "0", .at_most = "1"},
                                  std::vector<std::string>{});
  soil.passing_by = table.choice("passing_by", {"area", "number"}, "area") == "area" ? GradingMeasure::area
                                                                                     : GradingMeasure::number;
  if (soil.sizes.size() != soil.passing.size()) throw table.error("passing", "must have as many entries as sizes");
  if (soil.sizes.empty()) return;
  if (soil.sizes.size() < 2 || soil.passing.front() != 0.0 || soil.passing.back() != 1.0) {
    throw table.error("passing", "must rise from 0 to 1");
  }
  for (std::size_t k = 1; k < soil.sizes.size(); ++k) {
    if (soil.sizes[k] <= soil.sizes[k - 1]) throw table.error("sizes", "must ascend");
    if (soil.passing[k] < soil.passing[k - 1]) throw table.error("passing", "must not fall");
  }
  soil.size_minimum = soil.sizes.front();
  soil.size_maximum = soil.sizes.back();
}

void read_classes(const io::Table& table, SoilCase& soil) {
  for (const io::Table& entry : table.tables("class")) {
    GrainClassCase grains{.size_to = 0,
                          .modulus = soil.modulus,
                          .stiffness_ratio = soil.stiffness_ratio,
                          .friction_angle = soil.friction_angle,
                          .rolling_stiffness = soil.rolling_stiffness,
                          .rolling_limit = soil.rolling_limit};
    grains.size_to = entry.quantity("size_to", Dimension::length, size_rule);
    read_quantity(entry, "modulus", Dimension::pressure, grains.modulus, modulus_rule);
    read_quantity(entry, "stiffness_ratio", Dimension::none, grains.stiffness_ratio, stiffness_ratio_rule);
    read_quantity(entry, "friction", Dimension::angle, grains.friction_angle, friction_rule);
    read_quantity(entry, "rolling_stiffness", Dimension::none, grains.rolling_stiffness, rolling_rule);
    read_quantity(entry, "rolling_limit", Dimension::none, grains.rolling_limit, rolling_rule);
    if (!soil.classes.empty() && grains.size_to <= soil.classes.back().size_to)
      throw entry.error("size_to", "must ascend");
    soil.classes.push_back(grains);
  }
  if (!soil.classes.empty() && soil.classes.back().size_to < soil.size_maximum * (1 - 1e-12)) {
    throw table.error("class", "leaves the largest grains without a class");
  }
  if (soil.classes.size() > 255) throw table.error("class", "has more than 255 entries");
}

/// The packing in a file. The whole file is read, so that a fault in it is found before a run.
io::Packing packing_in(const io::Table& table, const std::filesystem::path& file) {
  try {
    return io::load_any_packing(file);
  } catch (const std::runtime_error& error) {
    throw table.error("file", error.what());
  }
}

/// Reads `file`, which names one file or several, and what depends on it.
void read_files(const io::Table& table, PackingCase& packing) {
  packing.files = table.optional_paths("file");
  if (!packing.files.empty()) packing.grains = 0;
  std::set<std::vector<double>> places;  // two names may lead to one packing, and two files hold copies of it
  for (const std::filesystem::path& file : packing.files) {
    const io::Packing there = packing_in(table, file);
    packing.grains = std::max(packing.grains, static_cast<int>(there.grains()));
    std::vector<double> x = there.x;
    std::sort(x.begin(), x.end());  // other programs may have another order of the same grains
    if (!places.insert(std::move(x)).second)
      throw table.error("file",
                        fmt::format("names a packing twice: {} holds the grains of another file", file.string()));
    if (packing.files.size() > 1 && file.extension() == ".h5")
      throw table.error("file", "names a stored state among others: a state is read alone");
  }
}

/// Reads `candidates` and `variety`. Without these keys all files are used, and one packing of those of the seeds.
void read_variety(const io::Table& table, bool on_a_mesh, PackingCase& packing) {
  packing.variety = packing.files.empty() ? 1 : static_cast<int>(packing.files.size());
  read_integer(table, "variety", packing.variety, {.at_least = 1, .at_most = most_variety});
  packing.candidates = on_a_mesh ? packing.variety : 1;
  read_integer(table, "candidates", packing.candidates, {.at_least = 1, .at_most = 1000});
}

}  // namespace

SoilCase read_soil(const io::Table& table) {
  SoilCase soil;
  read_grading(table, soil);
  if (soil.sizes.empty()) {
    read_quantity(table, "size_minimum", Dimension::length, soil.size_minimum, size_rule);
    read_quantity(table, "size_maximum", Dimension::length, soil.size_maximum, size_rule);
  }
  if (soil.size_maximum < soil.size_minimum) throw table.error("size_maximum", "is smaller than size_minimum");
  if (soil.size_maximum > 40 * soil.size_minimum) {
    throw table.error("size_maximum",
                      "is more than 40 times size_minimum: an RVE cannot hold grains of so different sizes");
  }
  read_quantity(table, "modulus", Dimension::pressure, soil.modulus, modulus_rule);
  read_quantity(table, "stiffness_ratio", Dimension::none, soil.stiffness_ratio, stiffness_ratio_rule);
  read_quantity(table, "friction", Dimension::angle, soil.friction_angle, friction_rule);
  read_quantity(table, "rolling_stiffness", Dimension::none, soil.rolling_stiffness, rolling_rule);
  read_quantity(table, "rolling_limit", Dimension::none, soil.rolling_limit, rolling_rule);
  read_quantity(table, "damping", Dimension::none, soil.damping, {.at_least = "0", .at_most = "0.9"});
  read_quantity(table, "density", Dimension::density, soil.density, {.at_least = "1 kg/m3", .at_most = "100000 kg/m3"});
  read_quantity(table, "thickness", Dimension::length, soil.thickness, {.at_least = "1 mm", .at_most = "100 m"});
  read_classes(table, soil);
  return soil;
}

PackingCase read_packing(const io::Table& table, bool on_a_mesh) {
  PackingCase packing;
  read_integer(table, "grains", packing.grains, {.at_least = 30, .at_most = 20000});
  packing.seed = table.integer("seed", {.fallback = packing.seed, .at_least = 0, .at_most = largest_seed});
  packing.seeds = table.integers("seeds", {.at_least = 0, .at_most = largest_seed}, std::vector<std::int64_t>{});
  if (packing.seeds.size() > most_seeds) throw table.error("seeds", "names more than 1000 seeds");
  if (std::set<std::int64_t>(packing.seeds.begin(), packing.seeds.end()).size() != packing.seeds.size()) {
    throw table.error("seeds", "names a seed twice");
  }
  read_quantity(table, "consolidation_friction", Dimension::none, packing.consolidation_friction,
                {.at_least = "0", .at_most = "2"});
  packing.consolidation_rolling = table.boolean("consolidation_rolling", packing.consolidation_rolling);
  read_quantity(table, "void_ratio", Dimension::none, packing.void_ratio, {.at_least = "0", .at_most = "1"});
  read_quantity(table, "pressure", Dimension::pressure, packing.pressure, {.at_least = "100 Pa", .at_most = "10 MPa"});
  packing.mirrored = table.boolean("mirrored", packing.mirrored);
  packing.folder = table.text("folder", packing.folder.string());
  std::error_code failure;
  const auto folder = std::filesystem::status(packing.folder, failure).type();
  const bool usable = folder == std::filesystem::file_type::directory ||
                      folder == std::filesystem::file_type::not_found;
  if (packing.folder.empty() || !usable) throw table.error("folder", "must name a folder, which may be a new one");
  read_files(table, packing);
  read_variety(table, on_a_mesh, packing);
  return packing;
}

void check_variety(const io::Table& table, const PackingCase& packing) {
  std::size_t there = static_cast<std::size_t>(packing.candidates);
  const char* key = "candidates";
  if (!packing.seeds.empty()) there = packing.seeds.size(), key = "seeds";
  if (!packing.files.empty()) there = packing.files.size(), key = "file";
  if (there < static_cast<std::size_t>(packing.variety)) {
    throw table.error("variety", fmt::format("asks for {} different packings, but packing.{} has only {}",
                                             packing.variety, key, there));
  }
}

}  // namespace voussoir::host
