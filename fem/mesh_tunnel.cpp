#include "fem/mesh_tunnel.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "fem/gauss_points.hpp"
#include "fem/mesh_gmsh.hpp"

namespace voussoir::fem {

namespace {

constexpr double max_elements = 2e6;  ///< more elements than this show that an element size is mistyped

void require(bool holds, const char* sentence) {
  if (!holds) throw std::invalid_argument(std::string("tunnel mesh: ") + sentence);
}

void check(const HalfTunnelOptions& o) {
  for (const double value : {o.width, o.height, o.diameter, o.cover, o.size_near, o.size_far})
    require(std::isfinite(value) && value > 0, "every length must be positive and finite");
  require(o.cover + o.diameter < o.height,
          "cover + diameter must be less than the height (the invert is above the base)");
  require(o.diameter / 2 < o.width, "the width must be more than half the diameter");
  require(o.size_near <= o.size_far, "size_near must not exceed size_far");
  require(o.size_near <= o.diameter / 2, "size_near must not exceed half the diameter");
  const double ring = o.diameter * std::max(o.diameter, o.cover);
  require(ring / (o.size_near * o.size_near) + o.width * o.height / (o.size_far * o.size_far) < max_elements,
          "the element sizes would make more than two million elements");
}

/// The boundaries in their order around the ground, as one chain that begins and ends at the origin.
std::vector<Edge> outline_of(const Mesh& mesh, double axis_y) {
  std::vector<Edge> outline;
  const auto append = [&](const char* name, auto&& wanted) {
    const std::vector<Edge>& chain = mesh.edge_set(name);
    std::copy_if(chain.begin(), chain.end(), std::back_inserter(outline), wanted);
  };
  const auto is_above = [&](const Edge& edge) { return mesh.coordinates(1, edge[1]) > axis_y; };
  const auto all = [](const Edge&) { return true; };
  append("base", all);
  append("side", all);
  append("top", all);
  append("axis", is_above);
  append("opening", all);
  append("axis", [&](const Edge& edge) { return !is_above(edge); });
  return outline;
}

/// @throws std::runtime_error where the boundaries do not run around the ground once, without a gap
void check_outline(const Mesh& mesh, double axis_y) {
  try {
    const std::vector<Edge> outline = outline_of(mesh, axis_y);
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const Edge& next = outline[(k + 1) % outline.size()];
      if (outline[k][2] != next[0]) throw std::runtime_error("tunnel mesh: its outline has a gap or a crossing");
    }
  } catch (const std::out_of_range& fault) {
    throw std::runtime_error(std::string("tunnel mesh: ") + fault.what());
  }
}

}  // namespace

QuadMesh half_tunnel_quads(const HalfTunnelOptions& options) {
  check(options);
  return generate_quads(options);
}

Mesh complete_half_tunnel(const HalfTunnelOptions& options, const QuadMesh& quads) {
  check(options);
  const Circle opening = opening_of(options);
  const auto on_circle = [&](const Point& x) {
    return std::abs((x - opening.centre).norm() - opening.radius) < 1e-12 * options.height;
  };
  Mesh mesh = complete_q8(quads.corners, quads.quads, [&](const Point& a, const Point& b) -> BoundaryPlace {
    if (on_circle(a) && on_circle(b)) return {"opening", -a.y()};
    return place_on_block(a, b, options.width, options.height);
  });
  check_outline(mesh, opening.centre.y());
  // Midside nodes are placed here and not by Gmsh, so that they lie exactly on the circle and have the numbers that
  // they have in every other mesh.
  for (const Edge& edge : mesh.edge_set("opening"))
    mesh.coordinates.col(edge[1]) = opening.project(mesh.coordinates.col(edge[1]));
  mesh.points["crown"] = mesh.node_set("opening").front();
  mesh.points["invert"] = mesh.node_set("opening").back();
  if (!(gauss_points(mesh, mesh.coordinates).smallest_jacobian > 0))
    throw std::runtime_error("tunnel mesh: an element is folded; try other element sizes");
  return mesh;
}

Mesh make_half_tunnel(const HalfTunnelOptions& options) {
  return complete_half_tunnel(options, half_tunnel_quads(options));
}

}  // namespace voussoir::fem
