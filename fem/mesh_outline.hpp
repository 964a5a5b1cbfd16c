#pragma once
/// Sorts edges into chains: the outer edges of a mesh, and curves inside it.

#include <vector>

#include "fem/mesh.hpp"

namespace voussoir::fem {

/// The outer edges of the elements that are not dug out, in no order, the soil on the left of each. Faces at which soil
/// has been dug out are among them.
/// @param dug_out as Mesh::dug_out
[[nodiscard]] std::vector<Edge> outline_of(const Mesh& mesh, const std::vector<char>& dug_out);

/// The outer edges of a mesh as loops: an edge starts where the one before it ends. A loop around the soil starts at
/// its lowest corner (of several, the leftmost one), a loop around a hole at its highest. Where soil touches soil at a
/// single corner, the loop follows the soil from which it came.
[[nodiscard]] std::vector<std::vector<Edge>> outline_loops(const Coordinates& coordinates,
                                                           const std::vector<Edge>& outer);

/// The nodes of edges in any order and direction, piece by piece in the order along the curve, each once.
[[nodiscard]] std::vector<int> curve_nodes(const std::vector<Edge>& edges);

}  // namespace voussoir::fem
