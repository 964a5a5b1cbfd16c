#pragma once
/// Loads and supports that several stages of the ground use: weight, surcharge, the tractions that hold the opening,
/// and supports.

#include <vector>

#include "fem/boundary.hpp"
#include "fem/mesh.hpp"
#include "host/case/case.hpp"
#include "host/scene/k0_table.hpp"

namespace voussoir::host {

/// Load factors of the increments of column and gravity.
[[nodiscard]] std::vector<double> gravity_targets(const GroundCase& soil, const GravityCase& gravity);

/// Nodal forces of weight and surcharge at load factor lambda [N/m].
[[nodiscard]] Eigen::VectorXd ground_weight(const fem::Mesh& mesh, const GroundCase& soil, double load_factor);

/// Tractions that hold the opening at load factor lambda, eqs. (15), (16) [N/m].
[[nodiscard]] Eigen::VectorXd opening_tractions(const fem::Mesh& mesh, const GroundCase& soil, const K0Table& k0,
                                                double load_factor);

/// The supports of the ground: the base is fixed; the sides and the axis of symmetry are on rollers.
[[nodiscard]] fem::Constraints ground_supports(const fem::Mesh& mesh);

/// The supports of the ground with a moving opening: it follows the loss of volume from one value of V_l to another.
/// Its crown and invert stay on the axis of symmetry.
[[nodiscard]] fem::Constraints volume_loss_constraints(const fem::Mesh& mesh, double from, double to);

}  // namespace voussoir::host
