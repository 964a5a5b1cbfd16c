#include "host/case/grains.hpp"

#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "host/case/keys.hpp"
#include "io/packing_file.hpp"
#include "io/units.hpp"

namespace voussoir::host {

using io::Dimension;

namespace {

/// Reads `sizes` and `passing`, a grading curve, which also sets the smallest and the largest size.
void read_grading(const io::Table& table, SoilCase& soil) {
  soil.sizes = table.quantities("sizes", Dimension::length, {.positive = true}, std::vector<std::string>{});
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
    grains.size_to = entry.quantity("size_to", Dimension::length, {.positive = true});
    read_quantity(entry, "modulus", Dimension::pressure, grains.modulus, {.positive = true});
    read_quantity(entry, "stiffness_ratio", Dimension::none, grains.stiffness_ratio, {.at_least = "0", .at_most = "2"});
    read_quantity(entry, "friction", Dimension::angle, grains.friction_angle,
                  {.at_least = "0 deg", .at_most = "80 deg"});
    read_quantity(entry, "rolling_stiffness", Dimension::none, grains.rolling_stiffness, {.at_least = "0"});
    read_quantity(entry, "rolling_limit", Dimension::none, grains.rolling_limit, {.at_least = "0"});
    if (!soil.classes.empty() && grains.size_to <= soil.classes.back().size_to)
      throw entry.error("size_to", "must ascend");
    soil.classes.push_back(grains);
  }
  if (!soil.classes.empty() && soil.classes.back().size_to < soil.size_maximum * (1 - 1e-12)) {
    throw table.error("class", "leaves the largest grains without a class");
  }
  if (soil.classes.size() > 255) throw table.error("class", "has more than 255 entries");
}

}  // namespace

SoilCase read_soil(const io::Table& table) {
  SoilCase soil;
  read_grading(table, soil);
  if (soil.sizes.empty()) {
    read_quantity(table, "size_minimum", Dimension::length, soil.size_minimum, {.positive = true});
    read_quantity(table, "size_maximum", Dimension::length, soil.size_maximum, {.positive = true});
  }
  if (soil.size_maximum < soil.size_minimum) throw table.error("size_maximum", "is smaller than size_minimum");
  if (soil.size_maximum > 40 * soil.size_minimum) {
    throw table.error("size_maximum",
                      "is more than 40 times size_minimum: an RVE cannot hold grains of so different sizes");
  }
  read_quantity(table, "modulus", Dimension::pressure, soil.modulus, {.positive = true});
  read_quantity(table, "stiffness_ratio", Dimension::none, soil.stiffness_ratio, {.at_least = "0", .at_most = "2"});
  read_quantity(table, "friction", Dimension::angle, soil.friction_angle, {.at_least = "0 deg", .at_most = "80 deg"});
  read_quantity(table, "rolling_stiffness", Dimension::none, soil.rolling_stiffness, {.at_least = "0"});
  read_quantity(table, "rolling_limit", Dimension::none, soil.rolling_limit, {.at_least = "0"});
  read_quantity(table, "damping", Dimension::none, soil.damping, {.at_least = "0", .at_most = "0.9"});
  read_quantity(table, "density", Dimension::density, soil.density, {.positive = true});
  read_quantity(table, "thickness", Dimension::length, soil.thickness, {.positive = true});
  read_classes(table, soil);
  return soil;
}

PackingCase read_packing(const io::Table& table) {
  PackingCase packing;
  read_integer(table, "grains", packing.grains, {.at_least = 30, .at_most = 20000});
  packing.seed = table.integer("seed", {.fallback = packing.seed, .at_least = 0});
  packing.seeds = table.integers("seeds", {.at_least = 0}, std::vector<std::int64_t>{});
  if (std::set<std::int64_t>(packing.seeds.begin(), packing.seeds.end()).size() != packing.seeds.size()) {
    throw table.error("seeds", "names a seed twice");
  }
  read_integer(table, "candidates", packing.candidates, {.at_least = 1, .at_most = 1000});
  read_quantity(table, "consolidation_friction", Dimension::none, packing.consolidation_friction,
                {.at_least = "0", .at_most = "2"});
  read_quantity(table, "void_ratio", Dimension::none, packing.void_ratio, {.at_least = "0", .at_most = "1"});
  read_quantity(table, "pressure", Dimension::pressure, packing.pressure, {.at_least = "100 Pa", .at_most = "10 MPa"});
  packing.mirrored = table.boolean("mirrored", packing.mirrored);
  packing.folder = table.text("folder", packing.folder.string());
  if (table.has("file")) {
    packing.file = table.path("file");
    try {
      const bool ours = packing.file.extension() == ".h5";
      packing.grains = static_cast<int>(
          (ours ? io::load_packing(packing.file) : io::load_packing_csv(packing.file)).grains());
    } catch (const std::runtime_error& error) {
      throw table.error("file", error.what());
    }
  }
  return packing;
}

}  // namespace voussoir::host
