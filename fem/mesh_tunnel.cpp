#include "fem/mesh_tunnel.hpp"

#include <gmsh.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "fem/gauss_points.hpp"
#include "fem/mesh_builder.hpp"

namespace voussoir::fem {

namespace {

constexpr double max_elements = 2e6;  ///< more elements than this show that an element size is mistyped

struct Circle {
  Point centre;
  double radius;
  [[nodiscard]] Point project(const Point& x) const { return centre + radius * (x - centre).normalized(); }
};

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

/// Owns Gmsh's global state while one mesh is made. Gmsh sets the process's OpenMP thread number to its own; the
/// destructor restores the number, because otherwise everything after a mesh would run on one thread.
class GmshSession {
 public:
  GmshSession() {
    gmsh::initialize(0, nullptr, false);
    gmsh::option::setNumber("General.Terminal", 0);
    gmsh::option::setNumber("General.NumThreads", 1);
    gmsh::model::add("half_tunnel");
  }
  ~GmshSession() {
    gmsh::finalize();
    omp_set_num_threads(threads_before_);
  }
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;

 private:
  int threads_before_ = omp_get_max_threads();
};

/// Adds the outline, counter-clockwise from the origin; a half circle needs two arcs of less than pi.
void add_geometry(const HalfTunnelOptions& o, const Circle& opening) {
  namespace geo = gmsh::model::geo;
  const double yc = opening.centre.y();
  const double r = opening.radius;
  const int base_axis = geo::addPoint(0, 0, 0);
  const int base_side = geo::addPoint(o.width, 0, 0);
  const int top_side = geo::addPoint(o.width, o.height, 0);
  const int top_axis = geo::addPoint(0, o.height, 0);
  const int crown = geo::addPoint(0, yc + r, 0);
  const int springline = geo::addPoint(r, yc, 0);
  const int invert = geo::addPoint(0, yc - r, 0);
  const int centre = geo::addPoint(0, yc, 0);
  const std::vector<int> loop{geo::addLine(base_axis, base_side),
                              geo::addLine(base_side, top_side),
                              geo::addLine(top_side, top_axis),
                              geo::addLine(top_axis, crown),
                              geo::addCircleArc(crown, centre, springline),
                              geo::addCircleArc(springline, centre, invert),
                              geo::addLine(invert, base_axis)};
  geo::addPlaneSurface({geo::addCurveLoop(loop)});
  geo::synchronize();
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

struct LinearMesh {
  Coordinates corners;
  std::vector<Quad> quads;
};

/// Reads quadrilaterals and their nodes from Gmsh, renumbered by ascending tag; nodes of no element (the circle's
/// centre) are left out.
LinearMesh extract() {
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> tags, element_nodes;
  gmsh::model::mesh::getElements(types, tags, element_nodes, 2);
  if (types.size() != 1 || types[0] != 3)
    throw std::runtime_error("tunnel mesh: Gmsh left other shapes than quadrilaterals");
  std::vector<std::size_t> used = element_nodes[0];
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  LinearMesh mesh;
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
  }
}

}  // namespace

Mesh make_half_tunnel(const HalfTunnelOptions& options) {
  check(options);
  const double invert_y = options.height - options.cover - options.diameter;
  const Circle opening{{0, invert_y + options.diameter / 2}, options.diameter / 2};
  LinearMesh linear;
  try {
    const GmshSession session;
    add_geometry(options, opening);
    generate(options, opening);
    linear = extract();
  } catch (const std::string& message) {  // Gmsh 4.8 throws texts
    throw std::runtime_error("tunnel mesh: Gmsh failed: " + message);
  }
  snap(linear.corners, options, opening);
  const auto on_circle = [&](const Point& x) {
    return std::abs((x - opening.centre).norm() - opening.radius) < 1e-12 * options.height;
  };
  Mesh mesh = complete_q8(linear.corners, linear.quads, [&](const Point& a, const Point& b) -> BoundaryPlace {
    if (on_circle(a) && on_circle(b)) return {"opening", -a.y()};
    return place_on_block(a, b, options.width, options.height);
  });
  // Midside nodes are placed here and not by Gmsh, so that they lie exactly on the circle and have the numbers that
  // they have in every other mesh.
  for (const Edge& edge : mesh.edge_set("opening"))
    mesh.coordinates.col(edge[1]) = opening.project(mesh.coordinates.col(edge[1]));
  mesh.nodes["crown"] = {mesh.node_set("opening").front()};
  mesh.nodes["invert"] = {mesh.node_set("opening").back()};
  if (!(gauss_points(mesh, mesh.coordinates).smallest_jacobian > 0))
    throw std::runtime_error("tunnel mesh: an element is folded; try other element sizes");
  return mesh;
}

}  // namespace voussoir::fem
