#pragma once
/// The mesh of half of the ground around a circular tunnel, made by Gmsh.

#include "fem/mesh.hpp"

namespace voussoir::fem {

struct HalfTunnelOptions {
  double width = 35.0;     ///< of the half domain [m]
  double height = 35.0;    ///< [m]
  double diameter = 5.0;   ///< D of the circular opening [m]
  double cover = 10.0;     ///< C, from the crown to the top [m]; the invert is at y = height - C - D
  double size_near = 0.5;  ///< element edge at the opening [m]; edges between crown and surface are 1.5 times as long
  double size_far = 2.5;   ///< largest element edge [m]
};

/// Half of the ground around a circular opening, x = 0 the symmetry axis. Corner and midside nodes of the opening lie
/// on the circle. All elements are quadrilaterals with a positive Jacobian at every Gauss point. The same options give
/// the same bits. Throws std::invalid_argument on options that make no mesh, std::runtime_error if Gmsh fails.
[[nodiscard]] Mesh make_half_tunnel(const HalfTunnelOptions& options);

}  // namespace voussoir::fem
