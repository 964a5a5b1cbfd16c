#pragma once
/// The Gauss points of a mesh at given nodal coordinates: gradients of the shape functions, volumes, positions.

#include <vector>

#include "fem/material_batch.hpp"
#include "fem/mesh.hpp"
#include "fem/q8.hpp"

namespace voussoir::fem {

struct GaussPoints {
  std::vector<q8::ShapeGradient> gradients;  ///< [1/m], n_points
  std::vector<double> volumes;               ///< weight * det J [m3 per m out of plane], n_points
  Coordinates positions;                     ///< 2 x n_points [m]
  double smallest_jacobian = 0;              ///< min det J over all points [m2]; not positive: the mesh is folded
};

/// The points of an element that has been dug out have no volume and no gradients, so that they add nothing to forces
/// and stiffness; their element may be folded.
[[nodiscard]] GaussPoints gauss_points(const Mesh& mesh, const Coordinates& coordinates);

/// Computes the gradient H_ij = d u_i / d x_j of a nodal vector field u (size n_dofs) at every Gauss point [-].
void displacement_gradients(const Mesh& mesh, const GaussPoints& points, const Eigen::VectorXd& u,
                            std::vector<Gradient>& gradients);

/// Engineering strain (xx, yy, gamma_xy) of a gradient [-].
[[nodiscard]] inline Eigen::Vector3d strain_of(const Gradient& h) { return {h(0, 0), h(1, 1), h(0, 1) + h(1, 0)}; }

}  // namespace voussoir::fem
