#pragma once
/// Fields for output: from Gauss points to elements and nodes.

#include "fem/gauss_points.hpp"

namespace voussoir::fem {

/// Volume-weighted mean over an element's points: components x n_points in, components x n_elements out.
[[nodiscard]] Eigen::MatrixXd element_means(const GaussPoints& points, const Eigen::MatrixXd& values);

/// Nodal values: bilinear extrapolation in each element, then the mean over the elements at a node weighted by their
/// volumes: components x n_points in, components x n_nodes out. Exact for fields linear in (xi, eta).
[[nodiscard]] Eigen::MatrixXd nodal_values(const Mesh& mesh, const GaussPoints& points, const Eigen::MatrixXd& values);

}  // namespace voussoir::fem
