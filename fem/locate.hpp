#pragma once
/// Finds the element at a place, and nodal values there.

#include <optional>
#include <span>

#include "fem/mesh.hpp"

namespace voussoir::fem {

/// A place within an element.
struct Located {
  int element = 0;
  double xi = 0, eta = 0;  ///< in the reference square [-1, 1]^2
};

/// The element that holds `x`, by Newton iteration on the map of each element whose box holds it; a place up to 1e-6 of
/// an element's size outside the mesh counts as on its edge. No value where no element holds it.
/// Of several elements, whose edge holds it, the one with the lowest `rank` counts; without ranks the first one.
[[nodiscard]] std::optional<Located> locate(const Mesh& mesh, const Coordinates& coordinates, const Point& x,
                                            std::span<const int> rank = {});

/// The value there of a nodal vector field, n_dofs.
[[nodiscard]] Point value_at(const Mesh& mesh, const Located& at, const Eigen::VectorXd& field);

/// The Gauss point of the element that is nearest in the reference square; an index as in Mesh::elements.
[[nodiscard]] int nearest_gauss_point(const Located& at);

}  // namespace voussoir::fem
