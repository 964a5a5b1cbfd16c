#include "host/case/scene_keys.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "host/case/keys.hpp"
#include "host/case/tables.hpp"

namespace voussoir::host {

namespace {

PlaceCase place_case(const io::Place& place) { return {.name = place.name, .at = place.at}; }

SupportCase read_support(const io::Table& entry) {
  SupportCase support;
  support.boundaries = entry.texts({"boundary", "Boundary that is held, or an array of boundaries, unless a point is."},
                                   std::vector<std::string>{}, column_name_rule, {.different = true, .or_one = true});
  const auto point = read_place(
      entry, {"point",
              "Point that is held: its name in the mesh, or coordinates, where a node of the mesh as drawn must lie."});
  if (support.boundaries.empty() == !point)
    throw entry.error(point ? "point" : "", "must have one of boundary and point");
  if (point) support.point = *point;
  const std::string fix = entry.choice({"fix", "Axes along which nothing moves: `x`, `y` or both (`xy`)."},
                                       {"x", "y", "xy"});
  support.x = fix != "y";
  support.y = fix != "x";
  return support;
}

RecordCase read_record(const io::Table& entry) {
  RecordCase record;
  record.name = entry.text({"name", "Name of the record in the names of its columns or of its table."}, {},
                           column_name_rule);
  record.point = read_place(
      entry, {"point", "Point whose displacement and stress become columns: its name in the mesh, or coordinates."});
  const std::vector<io::Place> line = entry.places(
      {"line", "Beginning and end of a line along which displacements and stresses are written as a table."},
      coordinate_rule, {.least = 2, .most = 2});
  if (!line.empty()) record.line = {place_case(line[0]), place_case(line[1])};
  const auto points = entry.optional_integer({"points", "Number of points of a line, its ends among them."},
                                             {.at_least = 2, .at_most = 10'000, .default_words = "50"});
  record.regions = entry.texts({"region",
                                "Region whose means become columns: of p, q, q/p, volumetric strain and void ratio "
                                "over its area; or an array of "
                                "regions, whose areas are taken together."},
                               std::vector<std::string>{}, column_name_rule, {.different = true, .or_one = true});
  if ((record.point ? 1 : 0) + (record.line ? 1 : 0) + (record.regions.empty() ? 0 : 1) != 1)
    throw entry.error("", "must have one of point, line and region");
  if (points && !record.line) throw entry.error("points", "is given without line");
  record.points = static_cast<int>(points.value_or(record.points));
  return record;
}

/// Refuses loads of weights where nothing has a weight.
void check_weights(const io::Table& root, const SceneCase& scene) {
  if (std::any_of(scene.regions.begin(), scene.regions.end(), [](const auto& r) { return r.unit_weight > 0; })) return;
  for (std::size_t k = 0; k < scene.stages.size(); ++k) {
    if (scene.stages[k].gravity.value_or(0) > 0)
      throw root.known_tables("stage")[k].error("gravity", "is not 0, but no region has a unit_weight above 0");
  }
}

}  // namespace

std::optional<PlaceCase> read_place(const io::Table& table, const io::Key& key) {
  const std::optional<io::Place> place = table.optional_place(key, coordinate_rule);
  if (!place) return std::nullopt;
  return place_case(*place);
}

void check_new_name(const io::Table& table, const std::string& name, const std::vector<std::string>& earlier) {
  if (std::find(earlier.begin(), earlier.end(), name) != earlier.end())
    throw table.error("name", fmt::format("'{}' is the name of an earlier one, too", name));
}

SceneCase read_scene(const io::Table& root, const Case& input) {
  SceneCase scene;
  scene.mesh = read_scene_mesh(root.table(tables::mesh));
  scene.regions = read_regions(root, input);
  for (const io::Table& entry : root.tables(tables::support)) scene.supports.push_back(read_support(entry));
  scene.stages = read_stages(root);
  std::vector<std::string> names;
  for (const io::Table& entry : root.tables(tables::record)) {
    scene.records.push_back(read_record(entry));
    check_new_name(entry, scene.records.back().name, names);
    names.push_back(scene.records.back().name);
  }
  check_weights(root, scene);
  return scene;
}

}  // namespace voussoir::host
