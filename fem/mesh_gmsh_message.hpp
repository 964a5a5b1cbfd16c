#pragma once
/// What a Gmsh file holds as bytes, which go from one process of this machine to another.

#include <string>

#include "fem/mesh_gmsh_file.hpp"

namespace voussoir::fem {

[[nodiscard]] std::string bytes_of(const GmshFile& file);

/// The inverse of bytes_of. The numbers of all lists fit one another: three coordinates for each node, nodes_each nodes
/// for each element, two nodes at least on curves and one on points, one element at least in a block. Throws
/// std::runtime_error where they do not.
[[nodiscard]] GmshFile gmsh_file_of(const std::string& bytes);

}  // namespace voussoir::fem
