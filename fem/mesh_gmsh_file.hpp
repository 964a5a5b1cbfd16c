#pragma once
/// What a Gmsh file holds, as Gmsh reads it.

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace voussoir::fem {

/// The elements of one shape on one point, curve, surface or volume of the geometry.
struct GmshBlock {
  int dimension = 0;                ///< 0: points, 1: curves, 2: surfaces, 3: volumes
  std::string shape;                ///< Gmsh's name, such as "Quadrilateral 8"
  int nodes_each = 0;               ///< nodes of an element
  std::vector<std::size_t> tags;    ///< of the elements
  std::vector<std::size_t> nodes;   ///< tags, nodes_each for each element
  std::vector<std::string> groups;  ///< names of the physical groups to which these elements belong
};

struct GmshFile {
  std::vector<std::size_t> node_tags;
  std::vector<double> positions;  ///< x, y, z of each node, in the unit of the file
  std::vector<GmshBlock> blocks;
  std::array<std::vector<std::string>, 4> groups;  ///< names by dimension, in the order of their tags
};

/// Time that Gmsh may take for a small file [s].
constexpr double gmsh_seconds = 60;

/// Reads a Gmsh file of version 2.2 or 4.1, text or binary, in a process of its own, because Gmsh may crash or hang
/// where the file is damaged. The process is ended after `seconds`, and 1 s more for each MB of the file. Only for a
/// file that begins with $MeshFormat: Gmsh runs any other one as a script. Groups without a name have their tag as a
/// name. Throws std::runtime_error of Gmsh's message, of how Gmsh ended, or where the program was built without Gmsh.
[[nodiscard]] GmshFile read_gmsh_file(const std::filesystem::path& path, double seconds = gmsh_seconds);

}  // namespace voussoir::fem
