#include "fem/mesh_tunnel.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "fem/gauss_points.hpp"
#include "fem/mesh_gmsh.hpp"
#include "fem/mesh_grid.hpp"

namespace voussoir::fem {

namespace {

void require(bool holds, const char* sentence) {
  if (!holds) throw std::invalid_argument(std::string("tunnel mesh: ") + sentence);
}

/// A line that touches the opening, or nearly so, makes elements without an angle.
void check_interfaces(const HalfTunnelOptions& o) {
  const Circle opening = opening_of(o);
  double below = 0;
  for (const double y : o.interfaces) {
    require(std::isfinite(y) && y > below, "the interfaces must ascend and lie above the base");
    require(y < o.height, "the interfaces must lie below the top");
    for (const double end : {opening.centre.y() - opening.radius, opening.centre.y() + opening.radius})
      require(std::abs(y - end) >= 0.5 * o.size_near,
              "an interface must be half the element size at the opening away from crown and invert");
    below = y;
  }
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
  check_interfaces(o);
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

bool is_on_circle(const HalfTunnelOptions& o, const Point& x) {
  const Circle opening = opening_of(o);
  return std::abs((x - opening.centre).norm() - opening.radius) < 1e-12 * o.height;
}

/// Puts the midsides of the opening on the circle and names crown and invert.
void finish(Mesh& mesh, const Circle& opening) {
  // Midside nodes are placed here and not by Gmsh, so that they lie exactly on the circle and have the numbers that
  // they have in every other mesh.
  for (const Edge& edge : mesh.edge_set("opening"))
    mesh.coordinates.col(edge[1]) = opening.project(mesh.coordinates.col(edge[1]));
  const std::vector<int>& nodes = mesh.node_set("opening");
  const auto [invert, crown] = std::minmax_element(
      nodes.begin(), nodes.end(), [&](int a, int b) { return mesh.coordinates(1, a) < mesh.coordinates(1, b); });
  mesh.points["crown"] = *crown;
  mesh.points["invert"] = *invert;
  if (!(gauss_points(mesh, mesh.coordinates).smallest_jacobian > 0))
    throw std::runtime_error("tunnel mesh: an element is folded; try other element sizes");
}

/// A half and its image in the axis x = 0, whose corners follow those of the half.
QuadMesh mirrored(const QuadMesh& half) {
  const int n = static_cast<int>(half.corners.cols());
  QuadMesh whole = half;
  std::vector<int> image(half.corners.cols());
  std::vector<int> copied;
  for (int k = 0; k < n; ++k) {
    image[k] = half.corners(0, k) == 0 ? k : n + static_cast<int>(copied.size());
    if (image[k] != k) copied.push_back(k);
  }
  whole.corners.conservativeResize(2, n + static_cast<Eigen::Index>(copied.size()));
  for (std::size_t k = 0; k < copied.size(); ++k)
    whole.corners.col(n + static_cast<Eigen::Index>(k)) << -half.corners(0, copied[k]), half.corners(1, copied[k]);
  for (const Quad& q : half.quads) whole.quads.push_back({image[q[0]], image[q[3]], image[q[2]], image[q[1]]});
  return whole;
}

}  // namespace

QuadMesh half_tunnel_quads(const HalfTunnelOptions& options) {
  check(options);
  return generate_quads(options);
}

Mesh complete_half_tunnel(const HalfTunnelOptions& options, const QuadMesh& quads) {
  check(options);
  const Circle opening = opening_of(options);
  Mesh mesh = complete_q8(quads, [&](int a, int b) -> std::string {
    if (is_on_circle(options, quads.corners.col(a)) && is_on_circle(options, quads.corners.col(b))) return "opening";
    return name_on_block(quads.corners.col(a), quads.corners.col(b), options.width, options.height);
  });
  if (!mesh.unnamed_edges.empty()) throw std::runtime_error("tunnel mesh: an outer edge is on no named boundary");
  check_outline(mesh, opening.centre.y());
  finish(mesh, opening);
  return mesh;
}

Mesh make_half_tunnel(const HalfTunnelOptions& options) {
  return complete_half_tunnel(options, half_tunnel_quads(options));
}

Mesh make_tunnel(const HalfTunnelOptions& half) {
  const QuadMesh quads = mirrored(half_tunnel_quads(half));
  Mesh mesh = complete_q8(quads, [&](int a, int b) -> std::string {
    const Point from = quads.corners.col(a);
    const Point to = quads.corners.col(b);
    if (is_on_circle(half, from) && is_on_circle(half, to)) return "opening";
    if (from.x() == -half.width && to.x() == -half.width) return "left";
    const std::string name = name_on_block(from, to, half.width, half.height);
    return name == "side" ? "right" : name;
  });
  finish(mesh, opening_of(half));
  return mesh;
}

std::vector<int> layers_of(const Mesh& mesh, const std::vector<double>& interfaces) {
  std::vector<int> layers;
  for (const ElementNodes& nodes : mesh.elements) {
    double y = 0;
    for (int k = 0; k < 4; ++k) y += 0.25 * mesh.coordinates(1, nodes[k]);
    layers.push_back(static_cast<int>(std::lower_bound(interfaces.begin(), interfaces.end(), y) - interfaces.begin()));
  }
  return layers;
}

}  // namespace voussoir::fem
