#pragma once
/// What holds for every mesh.

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "fem/gauss_points.hpp"
#include "fem/mesh.hpp"

namespace voussoir::mesh_checks {

inline double area(const fem::Mesh& mesh) {
  double sum = 0;
  for (const double v : fem::gauss_points(mesh, mesh.coordinates).volumes) sum += v;
  return sum;
}

/// The length of a boundary's straight edges [m].
inline double length(const fem::Mesh& mesh, const std::string& boundary) {
  double sum = 0;
  for (const fem::Edge& edge : mesh.edge_set(boundary))
    sum += (mesh.coordinates.col(edge[2]) - mesh.coordinates.col(edge[0])).norm();
  return sum;
}

/// The pieces of a boundary: one more than the edges that do not start where the one before them ends.
inline int pieces(const fem::Mesh& mesh, const std::string& boundary) {
  int n = 0;
  int end = -1;
  for (const fem::Edge& edge : mesh.edge_set(boundary)) {
    if (edge[0] != end) ++n;
    end = edge[2];
  }
  return n;
}

inline bool is_closed(const fem::Mesh& mesh, const std::string& boundary) {
  const std::vector<fem::Edge>& chain = mesh.edge_set(boundary);
  return pieces(mesh, boundary) == 1 && chain.front()[0] == chain.back()[2];
}

/// Every corner where one chain's edge ends, another edge starts; the area inside is the elements' area, so that the
/// chains have the soil on the left.
inline void expect_closed_outline(const fem::Mesh& mesh) {
  std::vector<int> balance(mesh.n_nodes(), 0);
  double inside = 0;
  const auto add = [&](const std::vector<fem::Edge>& chain) {
    for (const fem::Edge& edge : chain) ++balance[edge[0]], --balance[edge[2]];
    inside += fem::area_left_of(mesh.coordinates, chain);
  };
  for (const auto& [name, chain] : mesh.edges) add(chain);
  add(mesh.unnamed_edges);
  for (const int b : balance) EXPECT_EQ(b, 0);
  EXPECT_NEAR(inside, area(mesh), 1e-12 * area(mesh));
}

/// Outer edges are those of one element, each in one set; node sets are those of the edges, each node once; elements
/// are counter-clockwise; regions have an entry for each element.
inline void expect_sound(const fem::Mesh& mesh) {
  expect_closed_outline(mesh);
  EXPECT_GT(fem::gauss_points(mesh, mesh.coordinates).smallest_jacobian, 0);
  std::set<std::pair<int, int>> outer;  // directed: the neighbour has the edge the other way round
  std::set<int> used;
  for (const fem::ElementNodes& e : mesh.elements) {
    used.insert(e.begin(), e.end());
    for (int k = 0; k < 4; ++k)
      if (outer.erase({e[(k + 1) % 4], e[k]}) == 0) outer.emplace(e[k], e[(k + 1) % 4]);
  }
  EXPECT_EQ(used.size(), static_cast<std::size_t>(mesh.n_nodes()));
  const auto take = [&](const std::vector<fem::Edge>& chain) {
    for (const fem::Edge& edge : chain) EXPECT_EQ(outer.erase({edge[0], edge[2]}), 1u);
  };
  for (const auto& [name, chain] : mesh.edges) {
    take(chain);
    std::set<int> of_edges;
    for (const fem::Edge& edge : chain) of_edges.insert(edge.begin(), edge.end());
    const std::vector<int>& nodes = mesh.node_set(name);
    EXPECT_EQ(std::set<int>(nodes.begin(), nodes.end()).size(), nodes.size()) << name;
    EXPECT_TRUE(std::all_of(of_edges.begin(), of_edges.end(), [&](int node) {
      return std::find(nodes.begin(), nodes.end(), node) != nodes.end();
    })) << name;
  }
  take(mesh.unnamed_edges);
  EXPECT_TRUE(outer.empty());
  if (mesh.region_names.empty()) return;
  ASSERT_EQ(mesh.region.size(), mesh.elements.size());
  EXPECT_EQ(*std::max_element(mesh.region.begin(), mesh.region.end()) + 1, static_cast<int>(mesh.region_names.size()));
}

/// The area of each region, by its name [m2].
inline double region_area(const fem::Mesh& mesh, const std::string& region) {
  const std::vector<double> volumes = fem::gauss_points(mesh, mesh.coordinates).volumes;
  double sum = 0;
  for (int p = 0; p < mesh.n_points(); ++p)
    if (mesh.region_names[mesh.region[p / 4]] == region) sum += volumes[p];
  return sum;
}

}  // namespace voussoir::mesh_checks
