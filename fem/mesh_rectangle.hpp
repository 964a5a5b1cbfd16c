#pragma once
/// The mesh of a rectangle: columns and specimens.

#include "fem/mesh.hpp"

namespace voussoir::fem {

/// A rectangle of nx * ny elements with the boundaries "base", "side", "top", "axis". Throws std::invalid_argument.
[[nodiscard]] Mesh make_rectangle(double width, double height, int nx, int ny);

}  // namespace voussoir::fem
