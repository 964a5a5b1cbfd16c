#include "fem/mesh_builder.hpp"

#include <cstddef>
#include <set>
#include <sstream>
#include <stdexcept>

#include "fem/mesh_outline.hpp"

namespace voussoir::fem {

namespace {

[[noreturn]] void refuse_edge(const Coordinates& x, int a, int b) {
  std::ostringstream text;
  text << "an edge belongs to more than two elements: from (" << x(0, a) << ", " << x(1, a) << ") to (" << x(0, b)
       << ", " << x(1, b) << ")";
  throw std::runtime_error(text.str());
}

/// The names of a loop's edges, and the loop turned so that no boundary's piece is cut by the loop's start.
std::vector<std::string> name_loop(std::vector<Edge>& loop, const EdgeNamer& name_of) {
  std::vector<std::string> names;
  names.reserve(loop.size());
  for (const Edge& edge : loop) names.push_back(name_of(edge[0], edge[2]));
  if (loop.back()[2] != loop.front()[0]) return names;
  std::size_t last_change = loop.size();
  while (last_change > 0 && names[last_change - 1] == names.front()) --last_change;
  if (last_change == 0) return names;  // a closed chain
  std::rotate(loop.begin(), loop.begin() + static_cast<std::ptrdiff_t>(last_change), loop.end());
  std::rotate(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(last_change), names.end());
  return names;
}

void add_boundaries(Mesh& mesh, const std::vector<Edge>& outer, const EdgeNamer& name_of) {
  std::map<std::string, std::set<int>> seen;
  for (std::vector<Edge>& loop : outline_loops(mesh.coordinates, outer)) {
    const std::vector<std::string> names = name_loop(loop, name_of);
    for (std::size_t k = 0; k < loop.size(); ++k) {
      if (names[k].empty()) {
        mesh.unnamed_edges.push_back(loop[k]);
        continue;
      }
      mesh.edges[names[k]].push_back(loop[k]);
      for (const int node : loop[k])
        if (seen[names[k]].insert(node).second) mesh.nodes[names[k]].push_back(node);
    }
  }
}

}  // namespace

Mesh complete_q8(const QuadMesh& quads, const EdgeNamer& name_of) {
  struct Side {
    Edge edge;
    int elements = 0;
  };
  std::map<CornerPair, Side> sides;
  Mesh mesh;
  int next = static_cast<int>(quads.corners.cols());
  mesh.elements.reserve(quads.quads.size());
  for (const Quad& quad : quads.quads) {
    ElementNodes nodes{quad[0], quad[1], quad[2], quad[3]};
    for (int k = 0; k < 4; ++k) {
      const int a = quad[k];
      const int b = quad[(k + 1) % 4];
      const auto [entry, is_new] = sides.try_emplace(corner_pair(a, b));
      if (is_new) entry->second.edge = {a, next, b}, ++next;
      if (++entry->second.elements > 2) refuse_edge(quads.corners, a, b);
      nodes[4 + k] = entry->second.edge[1];
    }
    mesh.elements.push_back(nodes);
  }
  mesh.coordinates.resize(2, next);
  mesh.coordinates.leftCols(quads.corners.cols()) = quads.corners;
  std::vector<Edge> outer;
  for (const auto& [key, side] : sides) {
    const auto given = quads.midsides.find(key);
    mesh.coordinates.col(side.edge[1]) = given != quads.midsides.end() ? given->second
                                                                       : Point(0.5 * (quads.corners.col(side.edge[0]) +
                                                                                      quads.corners.col(side.edge[2])));
    if (side.elements == 1) outer.push_back(side.edge);
  }
  add_boundaries(mesh, outer, name_of);
  return mesh;
}

std::string name_on_block(const Point& a, const Point& b, double width, double height) {
  if (a.y() == 0 && b.y() == 0) return "base";
  if (a.x() == width && b.x() == width) return "side";
  if (a.y() == height && b.y() == height) return "top";
  if (a.x() == 0 && b.x() == 0) return "axis";
  return "";
}

std::map<CornerPair, int> midside_nodes(const Mesh& mesh) {
  std::map<CornerPair, int> nodes;
  for (const ElementNodes& element : mesh.elements)
    for (int k = 0; k < 4; ++k) nodes[corner_pair(element[k], element[(k + 1) % 4])] = element[4 + k];
  return nodes;
}

}  // namespace voussoir::fem
