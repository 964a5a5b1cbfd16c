#pragma once
/// From a case of the kind "scene" to the scene that is computed.

#include <vector>

#include "host/scene/records.hpp"
#include "host/scene/rest.hpp"
#include "host/scene/scene.hpp"

namespace voussoir::host {

/// A scene with its stages and records, checked against its mesh.
struct PlannedScene {
  Scene scene;
  std::vector<StagePlan> plans = {};
  std::vector<PlacedRecord> records = {};
  std::vector<std::string> remarks = {};  ///< what is worth telling about the mesh
  std::vector<GroundLayer> layers = {};   ///< from the surface down; empty where no stage presses at rest
};

/// Throws io::InputError with the place and the key at fault where the nouns of the scene do not fit one another.
[[nodiscard]] PlannedScene planned_scene(const Case& input);

}  // namespace voussoir::host
