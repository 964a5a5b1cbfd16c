#include "fem/mesh_builder.hpp"

#include <algorithm>
#include <stdexcept>

namespace voussoir::fem {

namespace {

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
    if (place.name.empty()) throw std::runtime_error("mesh: an outer edge is on no named boundary");
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

}  // namespace voussoir::fem
