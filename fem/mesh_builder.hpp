#pragma once
/// Makes a Q8 mesh with named boundaries from four-node quadrilaterals; every mesh is made in this way.

#include <functional>

#include "fem/mesh.hpp"

namespace voussoir::fem {

using Quad = std::array<int, 4>;  ///< corners, counter-clockwise

/// A mesh of four-node quadrilaterals, as a generator makes it.
struct QuadMesh {
  Coordinates corners;
  std::vector<Quad> quads;
};

/// The place of a boundary edge from a to b (soil on the left): the name of its boundary, and its place in the chain
/// (any number that grows along the chain).
struct BoundaryPlace {
  std::string name;
  double order;
};
using BoundaryClassifier = std::function<BoundaryPlace(const Point& a, const Point& b)>;

/// Adds midside nodes at the edges' centres, names the boundary edges and sorts them into chains. Throws
/// std::runtime_error if an edge belongs to more than two elements or a chain is broken.
[[nodiscard]] Mesh complete_q8(const Coordinates& corners, const std::vector<Quad>& quads,
                               const BoundaryClassifier& classify);

/// "base", "side", "top" or "axis" of a width x height block; an empty name where the edge is inside.
[[nodiscard]] BoundaryPlace place_on_block(const Point& a, const Point& b, double width, double height);

}  // namespace voussoir::fem
