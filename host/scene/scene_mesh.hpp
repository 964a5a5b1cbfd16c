#pragma once
/// The mesh of a scene: a file, or one of the shapes.

#include <string>
#include <vector>

#include "fem/mesh.hpp"
#include "host/case/scene.hpp"

namespace voussoir::host {

/// The mesh with its named boundaries, regions and points. Throws std::runtime_error with the sentences of
/// docs/reference/meshes.md, which begin with the key that is at fault ("mesh.file: ...").
[[nodiscard]] fem::Mesh scene_mesh(const SceneMeshCase& mesh);

struct SceneMesh {
  fem::Mesh mesh;
  std::vector<std::string> remarks;  ///< what is no fault of a mesh file, but worth telling; sentences without a key
};

/// As scene_mesh, with the remarks for `voussoir check`.
[[nodiscard]] SceneMesh scene_mesh_with_remarks(const SceneMeshCase& mesh);

}  // namespace voussoir::host
