#pragma once
/// The mesh of a scene: a file, or one of the shapes.

#include "fem/mesh.hpp"
#include "host/case/scene.hpp"

namespace voussoir::host {

/// The mesh with its named boundaries, regions and points. Throws std::runtime_error with the sentences of
/// docs/reference/meshes.md, which begin with the key that is at fault ("mesh.file: ...").
[[nodiscard]] fem::Mesh scene_mesh(const SceneMeshCase& mesh);

}  // namespace voussoir::host
