#pragma once
/// The mesh of a Gmsh file: its physical curves are boundaries, its physical surfaces regions, its physical points
/// points.

#include <filesystem>
#include <string>
#include <vector>

#include "fem/mesh.hpp"
#include "fem/mesh_gmsh_file.hpp"

namespace voussoir::fem {

struct MeshFile {
  Mesh mesh;
  std::vector<std::string> remarks;  ///< sentences about what is no fault, but may not be what the user wants
};

/// Reads elements of 8 nodes, and of 4 nodes, whose edges become straight edges of 8-node elements. `unit` is the
/// length of 1 in the file [m]. Elements that are clockwise are turned round; nodes of no element are left out;
/// midsides that are straight up to 1e-9 of their edge lie at its centre exactly, so that a mesh of the same corners
/// has the same bits, whoever made it. A physical point of several points has the names NAME_1, NAME_2 and so on.
/// Gmsh reads the file in a process of its own, which is ended after `seconds` (read_gmsh_file); a damaged file ends in
/// a mesh or in a sentence. Throws std::runtime_error with a sentence of docs/reference/meshes.md.
[[nodiscard]] MeshFile read_mesh_file(const std::filesystem::path& path, double unit, double seconds = gmsh_seconds);

}  // namespace voussoir::fem
