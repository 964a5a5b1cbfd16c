#pragma once
/// Prescribed displacements of nodes, as tests of the finite elements write them.

#include <vector>

#include "fem/boundary.hpp"

namespace voussoir::fem {

/// Prescribes `value` [m] on one axis (0: x, 1: y) of the nodes.
inline void constrain(Constraints& constraints, const std::vector<int>& nodes, int axis, double value) {
  for (const int node : nodes) constraints[2 * node + axis] = value;
}

}  // namespace voussoir::fem
