#include "fem/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "fem/mesh_builder.hpp"
#include "fem/q8.hpp"

namespace voussoir::fem {

namespace {

template <class Set>
const Set& find_set(const std::map<std::string, Set>& sets, const std::string& name) {
  const auto found = sets.find(name);
  if (found != sets.end()) return found->second;
  std::string known;
  for (const auto& [key, value] : sets) known += (known.empty() ? "" : ", ") + key;
  throw std::out_of_range("the mesh has no boundary '" + name + "'; it has " + known);
}

struct PlacedEdge {
  double order;
  Edge edge;
};

void add_chain(Mesh& mesh, const std::string& name, std::vector<PlacedEdge>& placed) {
  std::stable_sort(placed.begin(), placed.end(), [](const auto& a, const auto& b) { return a.order < b.order; });
  auto& chain = mesh.edges[name];
  auto& nodes = mesh.nodes[name];
  for (const auto& [order, edge] : placed) {
    chain.push_back(edge);
    for (const int node : edge)
      if (nodes.empty() || nodes.back() != node) nodes.push_back(node);
  }
}

}  // namespace

const std::vector<Edge>& Mesh::edge_set(const std::string& name) const { return find_set(edges, name); }
const std::vector<int>& Mesh::node_set(const std::string& name) const { return find_set(nodes, name); }

Mesh complete_q8(const Coordinates& corners, const std::vector<Quad>& quads, const BoundaryClassifier& classify) {
  struct Side {
    int mid;
    Edge edge;
    int elements = 0;
  };
  std::map<std::pair<int, int>, Side> sides;
  Mesh mesh;
  int next = static_cast<int>(corners.cols());
  for (const Quad& quad : quads) {
    ElementNodes nodes{quad[0], quad[1], quad[2], quad[3]};
    for (int k = 0; k < 4; ++k) {
      const int a = quad[k];
      const int b = quad[(k + 1) % 4];
      const auto [entry, is_new] = sides.try_emplace({std::min(a, b), std::max(a, b)});
      if (is_new) entry->second = {next, {a, next, b}}, ++next;
      if (++entry->second.elements > 2) throw std::runtime_error("mesh: an edge belongs to more than two elements");
      nodes[4 + k] = entry->second.mid;
    }
    mesh.elements.push_back(nodes);
  }
  mesh.coordinates.resize(2, next);
  mesh.coordinates.leftCols(corners.cols()) = corners;
  std::map<std::string, std::vector<PlacedEdge>> boundaries;
  for (const auto& [key, side] : sides) {
    const Point a = corners.col(side.edge[0]);
    const Point b = corners.col(side.edge[2]);
    mesh.coordinates.col(side.mid) = 0.5 * (a + b);
    if (side.elements == 2) continue;
    const BoundaryPlace place = classify(a, b);
    if (place.name.empty()) throw std::runtime_error("mesh: a boundary edge lies on no boundary");
    boundaries[place.name].push_back({place.order, side.edge});
  }
  for (auto& [name, placed] : boundaries) add_chain(mesh, name, placed);
  return mesh;
}

BoundaryPlace place_on_block(const Point& a, const Point& b, double width, double height) {
  if (a.y() == 0 && b.y() == 0) return {"base", a.x()};
  if (a.x() == width && b.x() == width) return {"side", a.y()};
  if (a.y() == height && b.y() == height) return {"top", -a.x()};
  if (a.x() == 0 && b.x() == 0) return {"axis", -a.y()};
  return {};
}

Mesh make_rectangle(double width, double height, int nx, int ny) {
  if (!(width > 0) || !(height > 0) || !std::isfinite(width) || !std::isfinite(height))
    throw std::invalid_argument("rectangle mesh: width and height must be positive and finite");
  if (nx < 1 || ny < 1 || nx > 10000 || ny > 10000)
    throw std::invalid_argument("rectangle mesh: nx and ny must be between 1 and 10000");
  Coordinates corners(2, (nx + 1) * (ny + 1));
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i)
      corners.col(j * (nx + 1) + i) << (i == nx ? width : width * i / nx), (j == ny ? height : height * j / ny);
  std::vector<Quad> quads;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const int first = j * (nx + 1) + i;
      quads.push_back({first, first + 1, first + nx + 2, first + nx + 1});
    }
  return complete_q8(corners, quads,
                     [&](const Point& a, const Point& b) { return place_on_block(a, b, width, height); });
}

double area_left_of(const Coordinates& coordinates, const std::vector<Edge>& chain) {
  double twice = 0;
  for (const Edge& edge : chain)
    for (std::size_t q = 0; q < q8::edge_points.size(); ++q) {
      const Eigen::Vector3d n = q8::edge_shape(q8::edge_points[q]);
      const Eigen::Vector3d d = q8::edge_shape_derivative(q8::edge_points[q]);
      Point x = Point::Zero();
      Point t = Point::Zero();
      for (int k = 0; k < 3; ++k) {
        x += n[k] * coordinates.col(edge[k]);
        t += d[k] * coordinates.col(edge[k]);
      }
      twice += q8::edge_weights[q] * (x.x() * t.y() - x.y() * t.x());
    }
  return 0.5 * twice;
}

}  // namespace voussoir::fem
