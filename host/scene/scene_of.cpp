#include "host/scene/scene_of.hpp"

#include <spdlog/fmt/fmt.h>

#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "host/case/scene_names.hpp"
#include "host/scene/boundary_columns.hpp"
#include "host/scene/records.hpp"
#include "host/scene/scene_checks.hpp"
#include "host/scene/scene_mesh.hpp"
#include "io/input_error.hpp"

namespace voussoir::host {
namespace {

template <class Map>
std::vector<std::string> names_of(const Map& map) {
  std::vector<std::string> names;
  for (const auto& [name, value] : map) names.push_back(name);
  return names;
}

/// The layers that a stage presses at rest, if any does.
std::vector<GroundLayer> layers_at_rest(const Scene& scene) {
  std::set<std::string> openings;
  std::string first_key;
  for (std::size_t s = 0; s < scene.input.stages.size(); ++s) {
    const std::vector<PressCase>& presses = scene.input.stages[s].presses;
    for (std::size_t k = 0; k < presses.size(); ++k) {
      if (presses[k].kind != PressKind::at_rest) continue;
      openings.insert(presses[k].boundary);
      if (first_key.empty()) first_key = fmt::format("stage[{}].press[{}].at_rest", s, k);
    }
  }
  return openings.empty() ? std::vector<GroundLayer>{} : level_layers(scene, openings, first_key);
}

/// No record writes a column that a boundary or an earlier record writes.
void check_columns(const PlannedScene& planned) {
  std::set<std::string> known;
  for (const std::string& name : column_names(watched(planned.plans), planned.scene.mesh)) known.insert(name);
  for (std::size_t k = 0; k < planned.records.size(); ++k) {
    for (const std::string& name : column_names(std::vector{planned.records[k]})) {
      if (!known.insert(name).second)
        throw std::runtime_error(fmt::format("record[{}].name: makes a second column {}", k, name));
    }
  }
}

PlannedScene make(const Case& input) {
  SceneMesh made = scene_mesh_with_remarks(input.scene.mesh);
  PlannedScene planned{.scene = {.input = input.scene,
                                 .mesh = std::move(made.mesh),
                                 .pressure = input.packing.pressure,
                                 .gravity = input.gravity},
                       .remarks = std::move(made.remarks)};
  const fem::Mesh& mesh = planned.scene.mesh;
  check_scene_names(input, {names_of(mesh.nodes), mesh.region_names, names_of(mesh.points)});
  planned.plans = plan_stages(planned.scene);
  for (std::size_t k = 0; k < planned.plans.size(); ++k) check_steps(planned.scene, planned.plans[k], k);
  planned.records = place_records(planned.scene, planned.plans);
  check_columns(planned);
  planned.layers = layers_at_rest(planned.scene);
  return planned;
}

}  // namespace

PlannedScene planned_scene(const Case& input) {
  try {
    return make(input);
  } catch (const io::InputError&) {
    throw;
  } catch (const std::runtime_error& fault) {
    const std::string text = fault.what();
    const std::size_t colon = text.find(": ");
    if (colon == std::string::npos) throw;
    const std::string key = text.substr(0, colon);
    throw io::InputError(place_of(input, key), key, text.substr(colon + 2));
  }
}

}  // namespace voussoir::host
