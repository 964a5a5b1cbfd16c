#pragma once
/// The faults of mesh files. Each function throws std::runtime_error, whose sentence says what to do in Gmsh.

#include <filesystem>
#include <string>
#include <vector>

#include "fem/mesh.hpp"
#include "fem/mesh_gmsh_file.hpp"

namespace voussoir::fem {

/// "(x, y)" as sentences have it.
[[nodiscard]] std::string place_text(const Point& x);

/// The names, with commas between them.
[[nodiscard]] std::string joined(const std::vector<std::string>& names);

/// A file that Gmsh would run as a script is refused here, and so is one beside which a script lies that Gmsh would run
/// with it (FILE.opt).
void check_is_mesh(const std::filesystem::path& path);

/// A text file of version 2 has all nodes that its elements name: Gmsh 4.8 crashes where it has not.
void check_nodes_of_version_2(const std::filesystem::path& path);

/// The file's last section is complete. Gmsh takes a file that is cut off within its last number as a whole one.
void check_has_end(const std::filesystem::path& path);

/// There are surface elements, two million at most, and all of them are quadrilaterals of 4 or 8 nodes.
void check_shapes(const GmshFile& file);

/// Each surface element is in one physical surface.
void check_regions(const GmshFile& file);

/// No node lies on another one, up to 1e-9 of the mesh's extent: two surfaces that only touch would fall apart.
void check_no_double_nodes(const Coordinates& nodes);

/// No corner of the outline lies on an edge of other elements, up to the same distance.
void check_no_corner_on_edge(const Mesh& mesh);

/// No element is folded; `tags` are those of the elements in the file.
void check_folded(const Mesh& mesh, const std::vector<std::size_t>& tags);

}  // namespace voussoir::fem
