#include <spdlog/fmt/fmt.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/case/grains.hpp"
#include "host/case/keys.hpp"
#include "host/case/mesh.hpp"
#include "host/case/scene_keys.hpp"
#include "host/case/tables.hpp"

namespace voussoir::host {

namespace {

/// Keys that say one thing in several ways, of which a region takes none over where it has one.
const io::TakeOverRule soil_rule{.alternatives = {{"sizes", "passing", "passing_by", "size_minimum", "size_maximum"}},
                                 .without = {}};
const io::TakeOverRule packing_rule{.alternatives = {{"consolidation_friction", "void_ratio"}, {"file", "grains"}},
                                    .without = {common_packing_keys.begin(), common_packing_keys.end()}};

/// Puts the tables of the files under `extends` below those of the region. Returns whether they have a soil.
bool take_files_over(const io::Table& entry, const io::Table& soil, const io::Table& packing) {
  const std::optional<io::CaseFile> files = entry.extended(
      {"extends",
       "Another case file, or an array of them, whose `[soil]` and `[packing]` this region takes over. Keys of the "
       "region itself go before them, and they go before those of `[soil]` and `[packing]` of the scene."});
  if (!files) return false;
  const io::Table other = files->root();
  const bool has_soil = other.has("soil"), has_packing = other.has("packing");
  if (!has_soil && !has_packing) throw entry.error("extends", "names a file with neither [soil] nor [packing]");
  if (has_soil) soil.take_over(other.table(tables::soil), soil_rule);
  if (has_packing) packing.take_over(other.table(tables::packing), packing_rule);
  return has_soil;
}

void read_grains(const io::Table& entry, const io::Table& root, const Case& input, RegionCase& region) {
  const io::Table soil = entry.table(tables::region_soil), packing = entry.table(tables::region_packing);
  for (const std::string_view key : common_packing_keys) {
    if (packing.has(key)) throw packing.error(key, fmt::format("is one for all regions: give packing.{}", key));
  }
  const bool has_own_soil = take_files_over(entry, soil, packing);
  io::TakeOverRule rule = soil_rule;
  if (has_own_soil) rule.without.push_back("class");  // a soil without classes is of one class
  soil.take_over(root.known_table("soil"), rule, "[soil]");
  packing.take_over(root.known_table("packing"), packing_rule, "[packing]");
  region.soil = read_soil(soil);
  region.packing = read_region_packing(packing, input.packing);
}

RegionCase read_region(const io::Table& entry, const io::Table& root, const Case& input) {
  RegionCase region;
  region.names = entry.texts(
      {"name",
       "Name of the region in the mesh, or an array of the names of regions that have the same weight and material."},
      {}, column_name_rule, {.least = 1, .different = true, .or_one = true});
  read_quantity(
      entry, {"unit_weight", "Unit weight of the region, which the load factor of stages with `gravity` multiplies."},
      io::Dimension::unit_weight, region.unit_weight, {.at_least = "0 N/m3", .at_most = "1 MN/m3"});
  if (!entry.has("elastic")) {
    read_grains(entry, root, input, region);
    return region;
  }
  for (const char* key : {"extends", "soil", "packing"}) {
    if (entry.has(key)) throw entry.error(key, "is given beside elastic: a region is elastic or of grains");
  }
  region.elastic = read_elastic(entry.table(tables::region_elastic));
  return region;
}

}  // namespace

std::vector<RegionCase> read_regions(const io::Table& root, const Case& input) {
  std::vector<RegionCase> regions;
  std::vector<std::string> names;
  for (const io::Table& entry : root.tables(tables::region)) {
    RegionCase region = read_region(entry, root, input);
    for (const std::string& name : region.names) {
      check_new_name(entry, name, names);
      names.push_back(name);
    }
    regions.push_back(std::move(region));
  }
  return regions;
}

}  // namespace voussoir::host
