#pragma once
/// Makes a Q8 mesh with named boundaries from quadrilaterals; every mesh is made in this way.

#include <algorithm>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "fem/mesh.hpp"

namespace voussoir::fem {

using Quad = std::array<int, 4>;  ///< corners, counter-clockwise

using CornerPair = std::pair<int, int>;  ///< the corners of an edge, the smaller index first

[[nodiscard]] inline CornerPair corner_pair(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// A mesh of quadrilaterals, as a generator makes it.
struct QuadMesh {
  Coordinates corners;  ///< [m]
  std::vector<Quad> quads;
  std::map<CornerPair, Point> midsides = {};  ///< of the edges that are not straight [m]
};

/// The name of the boundary on which the outer edge from corner a to corner b (soil on the left) lies; empty: on none.
using EdgeNamer = std::function<std::string(int a, int b)>;

/// Adds the midside nodes (those of edges that have none given at the edges' centres), names the outer edges and sorts
/// them into chains. The corners keep their indices; the midside nodes follow in the order in which the elements have
/// them. Throws std::runtime_error if an edge belongs to more than two elements.
[[nodiscard]] Mesh complete_q8(const QuadMesh& quads, const EdgeNamer& name_of);

/// "base", "side", "top" or "axis" of a width x height block; an empty name where the edge is inside.
[[nodiscard]] std::string name_on_block(const Point& a, const Point& b, double width, double height);

/// The node in the middle of each edge of a complete mesh.
[[nodiscard]] std::map<CornerPair, int> midside_nodes(const Mesh& mesh);

}  // namespace voussoir::fem
