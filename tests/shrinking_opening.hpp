#pragma once
/// The opening of a half tunnel that loses volume about its invert, eqs. (17)-(19).

#include "tests/constrain.hpp"

namespace voussoir::fem {

/// Prescribes the increment of volume loss from V_l = from to V_l = to on the nodes of "opening", on both axes.
inline void shrink_opening(Constraints& constraints, const Mesh& mesh, double from, double to) {
  const Point invert = mesh.coordinates.col(mesh.point("invert"));
  for (const int node : mesh.node_set("opening")) {
    const Point x = mesh.coordinates.col(node);
    const Point u = affine_displacement(x, invert, 0, -to) - affine_displacement(x, invert, 0, -from);
    constrain(constraints, {node}, 0, u.x());
    constrain(constraints, {node}, 1, u.y());
  }
}

}  // namespace voussoir::fem
