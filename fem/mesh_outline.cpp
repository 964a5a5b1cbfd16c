#include "fem/mesh_outline.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <tuple>

namespace voussoir::fem {

namespace {

using EdgesByCorner = std::multimap<int, std::size_t>;  ///< indices of edges

/// The angle from the outgoing edge, counter-clockwise over the soil, to the edge that came in [rad].
double soil_angle(const Coordinates& x, const Edge& in, const Edge& out) {
  const Point back = x.col(in[1]) - x.col(in[2]);
  const Point ahead = x.col(out[1]) - x.col(out[0]);
  const double angle = std::atan2(ahead.x() * back.y() - ahead.y() * back.x(), ahead.dot(back));
  return angle > 0 ? angle : angle + 2 * M_PI;
}

/// The unused edge that goes on after `in`, or end().
EdgesByCorner::iterator next_edge(const Coordinates& x, const std::vector<Edge>& edges, EdgesByCorner& by_start,
                                  const Edge& in) {
  const auto [first, last] = by_start.equal_range(in[2]);
  if (first == last) return by_start.end();
  return std::min_element(first, last, [&](const auto& a, const auto& b) {
    return soil_angle(x, in, edges[a.second]) < soil_angle(x, in, edges[b.second]);
  });
}

/// Twice the area within a loop of straight edges, positive where it runs counter-clockwise [m2].
double twice_area(const Coordinates& x, const std::vector<Edge>& loop) {
  double twice = 0;
  for (const Edge& edge : loop) twice += x(0, edge[0]) * x(1, edge[2]) - x(0, edge[2]) * x(1, edge[0]);
  return twice;
}

void turn_to_start(const Coordinates& x, std::vector<Edge>& loop) {
  const double sign = twice_area(x, loop) > 0 ? 1 : -1;
  const auto place = [&](const Edge& edge) { return std::tuple(sign * x(1, edge[0]), x(0, edge[0])); };
  const auto start = std::min_element(loop.begin(), loop.end(),
                                      [&](const Edge& a, const Edge& b) { return place(a) < place(b); });
  std::rotate(loop.begin(), start, loop.end());
}

}  // namespace

std::vector<Edge> outline_of(const Mesh& mesh, const std::vector<char>& dug_out) {
  std::map<int, Edge> once;  // by the midside node, which belongs to one edge of one or two elements
  for (int e = 0; e < mesh.n_elements(); ++e) {
    if (!dug_out.empty() && dug_out[e] != 0) continue;
    const ElementNodes& nodes = mesh.elements[e];
    for (int k = 0; k < 4; ++k) {
      const auto [found, is_new] = once.try_emplace(nodes[4 + k], Edge{nodes[k], nodes[4 + k], nodes[(k + 1) % 4]});
      if (!is_new) once.erase(found);
    }
  }
  std::vector<Edge> edges;
  for (const auto& [mid, edge] : once) edges.push_back(edge);
  return edges;
}

std::vector<std::vector<Edge>> outline_loops(const Coordinates& coordinates, const std::vector<Edge>& outer) {
  EdgesByCorner by_start;
  for (std::size_t k = 0; k < outer.size(); ++k) by_start.emplace(outer[k][0], k);
  std::vector<std::vector<Edge>> loops;
  while (!by_start.empty()) {
    std::vector<Edge> loop;
    auto next = by_start.begin();
    while (next != by_start.end()) {
      loop.push_back(outer[next->second]);
      by_start.erase(next);
      if (loop.back()[2] == loop.front()[0]) break;
      next = next_edge(coordinates, outer, by_start, loop.back());
    }
    if (loop.back()[2] == loop.front()[0]) turn_to_start(coordinates, loop);
    loops.push_back(std::move(loop));
  }
  return loops;
}

std::vector<int> curve_nodes(const std::vector<Edge>& edges) {
  EdgesByCorner by_corner;
  for (std::size_t k = 0; k < edges.size(); ++k)
    for (const int corner : {edges[k][0], edges[k][2]}) by_corner.emplace(corner, k);
  std::vector<int> nodes;
  std::set<int> seen;
  std::vector<char> is_used(edges.size(), 0);
  const auto add = [&](int node) {
    if (seen.insert(node).second) nodes.push_back(node);
  };
  const auto walk = [&](int corner) {
    while (true) {
      const auto [first, last] = by_corner.equal_range(corner);
      const auto next = std::find_if(first, last, [&](const auto& entry) { return is_used[entry.second] == 0; });
      if (next == last) return;
      const Edge& edge = edges[next->second];
      is_used[next->second] = 1;
      const int far_corner = edge[0] == corner ? edge[2] : edge[0];
      for (const int node : {corner, edge[1], far_corner}) add(node);
      corner = far_corner;
    }
  };
  for (const auto& [corner, edge] : by_corner)
    if (by_corner.count(corner) == 1) walk(corner);  // the ends of the open pieces first
  for (const auto& [corner, edge] : by_corner) walk(corner);
  return nodes;
}

}  // namespace voussoir::fem
