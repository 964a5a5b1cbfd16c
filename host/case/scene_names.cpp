#include "host/case/scene_names.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <algorithm>
#include <regex>
#include <string>
#include <vector>

#include "host/case/scene_keys.hpp"
#include "io/near_names.hpp"

namespace voussoir::host {

namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void add_new(std::vector<std::string>& names, const std::vector<std::string>& more) {
  for (const std::string& name : more) {
    if (!contains(names, name)) names.push_back(name);
  }
}

/// Compares the names in keys of a case with those of a mesh.
class NameCheck {
 public:
  NameCheck(const Case& input, const MeshNames& mesh) : input_(input), mesh_(mesh) {}

  void boundary(const std::string& key, const std::string& name) const {
    check(key, "boundary", name, mesh_.boundaries);
  }
  void regions(const std::string& key, const std::vector<std::string>& names) const {
    for (const std::string& name : names) check(key, "region", name, mesh_.regions);
  }
  void point(const std::string& key, const PlaceCase& place) const {
    if (!place.name.empty()) check(key, "point", place.name, mesh_.points);
  }
  [[nodiscard]] io::InputError error(const std::string& key, const std::string& sentence) const {
    return {place_of(input_, key), key, sentence};
  }

 private:
  void check(const std::string& key, const char* what, const std::string& name,
             const std::vector<std::string>& names) const {
    if (contains(names, name)) return;
    const std::string nearest = io::nearest_name(names, name);
    throw error(key, fmt::format("the mesh has no {} '{}'; it has {}{}", what, name,
                                 names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", ")),
                                 nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest)));
  }

  const Case& input_;
  const MeshNames& mesh_;
};

void check_stage(const NameCheck& check, const StageCase& stage, const std::string& table) {
  const auto key = [&](const char* change, std::size_t k, const char* name) {
    return fmt::format("{}.{}[{}].{}", table, change, k, name);
  };
  const auto check_target = [&](const char* change, std::size_t k, const auto& of) {
    if (of.boundary.empty())
      check.point(key(change, k, "point"), of.point);
    else
      check.boundary(key(change, k, "boundary"), of.boundary);
  };
  for (std::size_t k = 0; k < stage.moves.size(); ++k) {
    check_target("move", k, stage.moves[k]);
    check.point(key("move", k, "about"), stage.moves[k].about);
  }
  for (std::size_t k = 0; k < stage.presses.size(); ++k)
    check.boundary(key("press", k, "boundary"), stage.presses[k].boundary);
  for (std::size_t k = 0; k < stage.releases.size(); ++k) check_target("release", k, stage.releases[k]);
  for (std::size_t k = 0; k < stage.excavations.size(); ++k)
    check.regions(key("excavate", k, "region"), stage.excavations[k].regions);
}

void check_record(const NameCheck& check, const RecordCase& record, const std::string& table) {
  if (record.point) check.point(table + ".point", *record.point);
  if (record.line) {
    for (const PlaceCase& end : *record.line) check.point(table + ".line", end);
  }
  check.regions(table + ".region", record.regions);
}

void check_regions(const NameCheck& check, const SceneCase& scene, const MeshNames& mesh) {
  std::vector<std::string> given;
  for (std::size_t k = 0; k < scene.regions.size(); ++k) {
    check.regions(fmt::format("region[{}].name", k), scene.regions[k].names);
    add_new(given, scene.regions[k].names);
  }
  for (const std::string& name : mesh.regions) {
    if (!contains(given, name))
      throw check.error("mesh", fmt::format("region '{}' of the mesh has no [[region]]", name));
  }
}

}  // namespace

MeshNames names_of_shape(const SceneMeshCase& mesh) {
  MeshNames names;
  add_new(names.regions, mesh.layers);
  for (const std::vector<std::string>& row : mesh.regions) add_new(names.regions, row);
  switch (mesh.shape) {
    case MeshShape::file:
      return {};
    case MeshShape::grid:
      for (const auto& side : {mesh.base, mesh.right, mesh.top, mesh.left}) add_new(names.boundaries, side);
      names.points = {"base_left", "base_right", "top_left", "top_right"};
      break;
    case MeshShape::half_tunnel:
      names.boundaries = {"base", "right", "top", "axis", "opening"};
      names.points = {"crown", "invert"};
      break;
    case MeshShape::tunnel:
      names.boundaries = {"base", "left", "right", "top", "opening"};
      names.points = {"crown", "invert"};
      break;
    case MeshShape::ring:
      names.boundaries = {"cavity", "far"};
      if (mesh.part != RingPart::whole) names.boundaries.emplace_back("x0");
      if (mesh.part == RingPart::quarter) names.boundaries.emplace_back("y0");
      break;
  }
  return names;
}

void check_scene_names(const Case& input, const MeshNames& mesh) {
  const NameCheck check(input, mesh);
  const SceneCase& scene = input.scene;
  for (const std::string& name : mesh.boundaries) {
    if (!std::regex_match(name, std::regex(column_name_rule.pattern)))
      throw check.error("mesh.file", fmt::format("the boundary '{}' {}", name, column_name_rule.fault));
  }
  check_regions(check, scene, mesh);
  for (std::size_t k = 0; k < scene.supports.size(); ++k) {
    const std::string table = fmt::format("support[{}]", k);
    for (const std::string& name : scene.supports[k].boundaries) check.boundary(table + ".boundary", name);
    if (scene.supports[k].boundaries.empty()) check.point(table + ".point", scene.supports[k].point);
  }
  for (std::size_t k = 0; k < scene.stages.size(); ++k)
    check_stage(check, scene.stages[k], fmt::format("stage[{}]", k));
  for (std::size_t k = 0; k < scene.records.size(); ++k)
    check_record(check, scene.records[k], fmt::format("record[{}]", k));
}

}  // namespace voussoir::host
