#pragma once
/// Prescribed displacements and consistent nodal forces. Forces are per metre out of plane: vectors of n_dofs [N/m].

#include <functional>
#include <map>

#include "fem/material_batch.hpp"
#include "fem/mesh.hpp"

namespace voussoir::fem {

/// Prescribed displacement increments by degree of freedom (2 * node + axis) [m].
using Constraints = std::map<int, double>;

/// Prescribes `value` on one axis (0: x, 1: y) of the nodes. Throws std::invalid_argument where another value is
/// prescribed already.
void constrain(Constraints& constraints, const std::vector<int>& nodes, int axis, double value);

/// Displacement of the eccentric volume loss V_l, eqs. (17)-(19), which is a homothety about the invert:
/// u = (sqrt(1 - V_l) - 1)(x - x_invert) [m] with x the original coordinates and V_l the total loss, 0 <= V_l < 1.
/// Increments are differences of two calls.
[[nodiscard]] Point volume_loss_displacement(const Point& x, const Point& invert, double volume_loss);

/// Prescribes the increment of volume loss from V_l = from to V_l = to on the nodes of "opening", on both axes.
void constrain_volume_loss(Constraints& constraints, const Mesh& mesh, double from, double to);

using StressField = std::function<Stress(const Point&)>;  ///< Cauchy stress at a point of the boundary [Pa]

/// Nodal forces of a body force b [N/m3], e.g. (0, -unit weight).
[[nodiscard]] Eigen::VectorXd body_force(const Mesh& mesh, const Coordinates& coordinates, const Point& b);

/// Nodal forces of a pressure p [Pa] on boundary edges: t = -p N with N out of the soil, so that a positive p pushes on
/// the soil.
[[nodiscard]] Eigen::VectorXd pressure_force(const Coordinates& coordinates, const std::vector<Edge>& edges, double p);

/// Nodal forces of the tractions t = sigma(x) N of a stress field, eqs. (15), (16), with N out of the soil and three
/// Gauss points an edge.
[[nodiscard]] Eigen::VectorXd traction_force(const Coordinates& coordinates, const std::vector<Edge>& edges,
                                             const StressField& field);

/// The stress of ground at rest at load factor lambda:
/// s_yy = -(lambda * unit_weight * (height - y) + surcharge), s_xx = K0(s_yy) s_yy, s_xy = 0. `k0` takes s_yy
/// (negative) [Pa].
struct GeostaticStress {
  double unit_weight;  ///< [N/m3]
  double height;       ///< y of the surface [m]
  double surcharge;    ///< [Pa]
  double load_factor;  ///< lambda [-]
  std::function<double(double)> k0;
  [[nodiscard]] Stress operator()(const Point& x) const;
};

}  // namespace voussoir::fem
