#pragma once
/// Prescribed displacements and consistent nodal forces. Forces are per metre out of plane: vectors of n_dofs [N/m].

#include <functional>
#include <map>
#include <span>
#include <vector>

#include "fem/material_batch.hpp"
#include "fem/mesh.hpp"

namespace voussoir::fem {

/// Prescribed displacement increments by degree of freedom (2 * node + axis) [m].
using Constraints = std::map<int, double>;

/// Displacement [m] of the affine motion about `centre` that turns by `rotation` [rad, counter-clockwise] and changes
/// areas by the share `area` > -1: u = (s R - 1)(x - centre) with s = sqrt(1 + area) and x the original coordinates.
/// With area = -V_l and the invert as centre it is the eccentric volume loss of eqs. (17)-(19). Increments are
/// differences of two calls.
[[nodiscard]] Point affine_displacement(const Point& x, const Point& centre, double rotation, double area);

using StressField = std::function<Stress(const Point&)>;  ///< Cauchy stress at a point of the boundary [Pa]

/// Nodal forces of a body force b [N/m3], e.g. (0, -unit weight): one for all elements, or one of each element.
[[nodiscard]] Eigen::VectorXd body_force(const Mesh& mesh, const Coordinates& coordinates, const Point& b);
[[nodiscard]] Eigen::VectorXd body_force(const Mesh& mesh, const Coordinates& coordinates, std::span<const Point> b);

/// Nodal forces of a pressure p [Pa] on boundary edges: t = -p N with N out of the soil, so that a positive p pushes on
/// the soil.
[[nodiscard]] Eigen::VectorXd pressure_force(const Coordinates& coordinates, const std::vector<Edge>& edges, double p);

/// Nodal forces of the same traction [Pa] everywhere on boundary edges.
[[nodiscard]] Eigen::VectorXd constant_traction_force(const Coordinates& coordinates, const std::vector<Edge>& edges,
                                                      const Point& traction);

/// Nodal forces of the tractions t = sigma(x) N of a stress field, eqs. (15), (16), with N out of the soil and three
/// Gauss points an edge.
[[nodiscard]] Eigen::VectorXd traction_force(const Coordinates& coordinates, const std::vector<Edge>& edges,
                                             const StressField& field);

/// A level layer of ground.
struct Layer {
  double bottom = 0;       ///< y of its base [m]
  double unit_weight = 0;  ///< [N/m3]
};

/// The stress of ground at rest under a level surface at load factor lambda:
/// s_yy = -(sum over the layers above of lambda * unit_weight * thickness + surcharge), s_xx = K0 s_yy, s_xy = 0.
struct GeostaticStress {
  std::vector<Layer> layers;  ///< from the surface down; the last one goes on below its base
  double height;              ///< y of the surface [m]
  double surcharge;           ///< [Pa]
  double load_factor;         ///< lambda [-]
  std::function<double(std::size_t layer, double s_yy)> k0;  ///< of a layer at s_yy (negative) [Pa]
  [[nodiscard]] Stress operator()(const Point& x) const;
};

}  // namespace voussoir::fem
