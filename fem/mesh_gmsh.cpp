#include "fem/mesh_gmsh.hpp"

#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

#include "fem/mesh_gmsh_session.hpp"

namespace voussoir::fem {

namespace {

/// The wanted edge length: smallest at the opening, 1.5 times as long in the column of soil between crown and surface
/// (there the ground slides), and growing away from both.
double target_size(const HalfTunnelOptions& o, const Circle& opening, double x, double y) {
  constexpr double growth = 0.085;  // edge length gained per metre of distance: 800 to 890 elements with the defaults
  const double from_opening = std::max(0.0, (Point(x, y) - opening.centre).norm() - opening.radius);
  const double beside = std::max(0.0, x - opening.radius);
  const double below = std::max(0.0, opening.centre.y() + opening.radius - y);
  const double from_column = std::hypot(beside, below);
  return std::min({o.size_near + growth * from_opening, 1.5 * o.size_near + growth * from_column, o.size_far});
}

/// A corner of the outline of a layer.
struct Corner {
  Point position;
  bool on_circle = false;
};

/// Half the width of the opening at a height [m]; 0 above the crown and below the invert.
double half_chord(const Circle& opening, double y) {
  const double above = y - opening.centre.y();
  return std::sqrt(std::max(0.0, (opening.radius - above) * (opening.radius + above)));
}

/// The outline of the ground between two heights, counter-clockwise from its lower left corner. A half circle needs two
/// arcs of less than pi.
std::vector<Corner> layer_outline(const HalfTunnelOptions& o, const Circle& opening, double y0, double y1) {
  const double yc = opening.centre.y();
  const double crown = yc + opening.radius;
  const double invert = yc - opening.radius;
  const auto is_beside = [&](double y) { return invert < y && y < crown; };
  std::vector<Corner> corners{{{half_chord(opening, y0), y0}, is_beside(y0)},
                              {{o.width, y0}},
                              {{o.width, y1}},
                              {{half_chord(opening, y1), y1}, is_beside(y1)}};
  if (y0 < crown && crown < y1) corners.push_back({{0, crown}, true});
  if (y0 < yc && yc < y1) corners.push_back({{opening.radius, yc}, true});
  if (y0 < invert && invert < y1) corners.push_back({{0, invert}, true});
  return corners;
}

/// Adds points and curves to Gmsh's model, each once.
class Geometry {
 public:
  int point(const Point& position) {
    const auto [entry, is_new] = points_.try_emplace({position.x(), position.y()});
    if (is_new) entry->second = gmsh::model::geo::addPoint(position.x(), position.y(), 0);
    return entry->second;
  }
  /// The curve from a to b, negative where it was added from b to a.
  int curve(const Corner& a, const Corner& b, const Point& centre) {
    const int from = point(a.position);
    const int to = point(b.position);
    if (const auto known = curves_.find({to, from}); known != curves_.end()) return -known->second;
    const auto [entry, is_new] = curves_.try_emplace({from, to});
    if (is_new)
      entry->second = a.on_circle && b.on_circle ? gmsh::model::geo::addCircleArc(from, point(centre), to)
                                                 : gmsh::model::geo::addLine(from, to);
    return entry->second;
  }

 private:
  std::map<std::pair<double, double>, int> points_;
  std::map<std::pair<int, int>, int> curves_;
};

/// Adds the outlines of the layers, from the base upwards.
void add_geometry(const HalfTunnelOptions& o, const Circle& opening) {
  Geometry geometry;
  std::vector<double> heights{0};
  heights.insert(heights.end(), o.interfaces.begin(), o.interfaces.end());
  heights.push_back(o.height);
  for (std::size_t layer = 0; layer + 1 < heights.size(); ++layer) {
    const std::vector<Corner> corners = layer_outline(o, opening, heights[layer], heights[layer + 1]);
    for (const Corner& corner : corners) geometry.point(corner.position);
    geometry.point(opening.centre);  // the mesh's bits depend on the order in which Gmsh is given points
    std::vector<int> loop;
    for (std::size_t k = 0; k < corners.size(); ++k)
      loop.push_back(geometry.curve(corners[k], corners[(k + 1) % corners.size()], opening.centre));
    gmsh::model::geo::addPlaneSurface({gmsh::model::geo::addCurveLoop(loop)});
  }
  gmsh::model::geo::synchronize();
}

void generate(const HalfTunnelOptions& o, const Circle& opening) {
  using gmsh::option::setNumber;
  setNumber("Mesh.MeshSizeExtendFromBoundary", 0);
  setNumber("Mesh.MeshSizeFromPoints", 0);
  setNumber("Mesh.Algorithm", 6);  // frontal Delaunay
  setNumber("Mesh.RecombineAll", 1);
  // Algorithm 2 recombines a mesh twice as coarse and then splits it, which leaves nothing but quadrilaterals.
  setNumber("Mesh.RecombinationAlgorithm", 2);
  setNumber("Mesh.RandomSeed", 1);
  gmsh::model::mesh::setSizeCallback(
      [&](int, int, double x, double y, double) { return target_size(o, opening, x, y); });
  gmsh::model::mesh::generate(2);
}

/// Reads quadrilaterals and their nodes from Gmsh, renumbered by ascending tag; nodes of no element (the circle's
/// centre) are left out.
QuadMesh extract() {
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> tags, element_nodes;
  gmsh::model::mesh::getElements(types, tags, element_nodes, 2);
  if (types.size() != 1 || types[0] != 3) throw std::runtime_error("Gmsh left other shapes than quadrilaterals");
  std::vector<std::size_t> used = element_nodes[0];
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  QuadMesh mesh;
  mesh.corners.resize(2, static_cast<Eigen::Index>(used.size()));
  std::vector<double> x, parametric;
  for (std::size_t i = 0; i < used.size(); ++i) {
    gmsh::model::mesh::getNode(used[i], x, parametric);
    mesh.corners.col(static_cast<Eigen::Index>(i)) << x[0], x[1];
  }
  for (std::size_t first = 0; first < element_nodes[0].size(); first += 4) {
    Quad quad;
    for (std::size_t k = 0; k < 4; ++k) {
      const auto place = std::lower_bound(used.begin(), used.end(), element_nodes[0][first + k]);
      quad[k] = static_cast<int>(place - used.begin());
    }
    const Point a = mesh.corners.col(quad[2]) - mesh.corners.col(quad[0]);
    const Point b = mesh.corners.col(quad[3]) - mesh.corners.col(quad[1]);
    if (a.x() * b.y() < a.y() * b.x()) std::swap(quad[1], quad[3]);  // the nodes were clockwise
    mesh.quads.push_back(quad);
  }
  return mesh;
}

/// Puts nodes that are on a boundary up to rounding onto it exactly, so that later comparisons need no tolerance.
void snap(Coordinates& corners, const HalfTunnelOptions& o, const Circle& opening) {
  const double near = 1e-8 * std::min(o.size_near, o.diameter);
  for (auto x : corners.colwise()) {
    const Point position = x;
    if (std::abs((position - opening.centre).norm() - opening.radius) < near) x = opening.project(position);
    if (std::abs(x.x()) < near) x.x() = 0;
    if (std::abs(x.x() - o.width) < near) x.x() = o.width;
    if (std::abs(x.y()) < near) x.y() = 0;
    if (std::abs(x.y() - o.height) < near) x.y() = o.height;
    for (const double y : o.interfaces)
      if (std::abs(x.y() - y) < near) x.y() = y;
  }
}

}  // namespace

QuadMesh generate_quads(const HalfTunnelOptions& options) {
  const Circle opening = opening_of(options);
  QuadMesh mesh = call_gmsh(
      [&] {
        const GmshSession session;
        add_geometry(options, opening);
        generate(options, opening);
        return extract();
      },
      "tunnel mesh: Gmsh failed: ");
  snap(mesh.corners, options, opening);
  return mesh;
}

}  // namespace voussoir::fem
