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

/// Reads a Gmsh file of version 2.2 or 4.1, text or binary. Only for a file that begins with $MeshFormat: Gmsh runs any
/// other one as a script. Groups without a name have their tag as a name. Throws std::runtime_error of Gmsh's message,
/// or where the program was built without Gmsh.
[[nodiscard]] GmshFile read_gmsh_file(const std::filesystem::path& path);

}  // namespace voussoir::fem
