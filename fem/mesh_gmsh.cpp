#include "fem/mesh_gmsh.hpp"

#include <gmsh.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

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

/// Reads quadrilaterals and their nodes from Gmsh, renumbered by ascending tag; nodes of no element (the circle's
/// centre) are left out.
QuadMesh extract() {
  std::vector<int> types;
  std::vector<std::vector<std::size_t>> tags, element_nodes;
  gmsh::model::mesh::getElements(types, tags, element_nodes, 2);
  if (types.size() != 1 || types[0] != 3)
    throw std::runtime_error("tunnel mesh: Gmsh left other shapes than quadrilaterals");
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
  }
}

}  // namespace

QuadMesh generate_quads(const HalfTunnelOptions& options) {
  const Circle opening = opening_of(options);
  QuadMesh mesh;
  try {
    const GmshSession session;
    add_geometry(options, opening);
    generate(options, opening);
    mesh = extract();
  } catch (const std::string& message) {  // Gmsh 4.8 throws texts
    throw std::runtime_error("tunnel mesh: Gmsh failed: " + message);
  }
  snap(mesh.corners, options, opening);
  return mesh;
}

}  // namespace voussoir::fem
