#pragma once
/// The mesh of half of the ground around a circular tunnel, whose quadrilaterals Gmsh generates (mesh_gmsh.hpp).

#include "fem/mesh.hpp"
#include "fem/mesh_builder.hpp"
#include "fem/tunnel_outline.hpp"

namespace voussoir::fem {

/// The quadrilaterals of such a mesh, as they may be stored in a file. Throws as make_half_tunnel.
[[nodiscard]] QuadMesh half_tunnel_quads(const HalfTunnelOptions& options);

/// The mesh of these quadrilaterals, made with the same options. Throws std::invalid_argument on options that make no
/// mesh, std::runtime_error where the outline of the quadrilaterals is not that of the options, or an element is
/// folded.
[[nodiscard]] Mesh complete_half_tunnel(const HalfTunnelOptions& options, const QuadMesh& quads);

/// Half of the ground around a circular opening, x = 0 the symmetry axis. Its boundaries are
/// "base", "side", "top", "axis" (two pieces) and "opening", its points "crown" and "invert". Corner and midside nodes
/// of the opening lie on the circle. All elements are quadrilaterals with a positive Jacobian at every Gauss point. The
/// same options give the same bits. Throws std::invalid_argument on options that make no mesh, std::runtime_error if
/// Gmsh fails.
[[nodiscard]] Mesh make_half_tunnel(const HalfTunnelOptions& options);

/// Both halves of the ground around a circular opening: the mesh of the half that the options describe, and its image
/// in the axis x = 0. Its boundaries are "base", "right", "top", "left" and "opening", which is closed and starts at
/// the crown. Throws as make_half_tunnel.
[[nodiscard]] Mesh make_tunnel(const HalfTunnelOptions& half);

/// The layer of each element, counted from the base, where `interfaces` are the ascending heights of the lines between
/// them [m].
[[nodiscard]] std::vector<int> layers_of(const Mesh& mesh, const std::vector<double>& interfaces);

}  // namespace voussoir::fem
