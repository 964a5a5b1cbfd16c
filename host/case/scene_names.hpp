#pragma once
/// Names of boundaries, regions and points: those that a scene uses and those that its mesh has.

#include <string>
#include <vector>

#include "host/case/case.hpp"

namespace voussoir::host {

struct MeshNames {
  std::vector<std::string> boundaries, regions, points;
};

/// The names that a shape's mesh has, without making it; empty lists for a mesh file.
[[nodiscard]] MeshNames names_of_shape(const SceneMeshCase& mesh);

/// Throws io::InputError with the place of the key in the case where the scene names a boundary, a region or a point
/// that the mesh does not have, where a region of the mesh has no [[region]], or where a boundary has a name that no
/// column can have. For shapes load_case has called it; with a mesh file it is to be called when the file is read.
void check_scene_names(const Case& input, const MeshNames& mesh);

}  // namespace voussoir::host
