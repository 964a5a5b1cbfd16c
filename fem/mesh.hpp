#pragma once
/// Meshes of eight-node quadrilaterals (Q8, serendipity) with named boundaries, regions and points.
///
/// x to the right, y up, metres; a tunnel's ground has the origin at the base on the tunnel's vertical axis. Element
/// nodes: corners 0-3 counter-clockwise, then the midsides 4 (0-1), 5 (1-2), 6 (2-3), 7 (3-0). Degree of freedom 2*node
/// is u_x, 2*node + 1 is u_y.

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <vector>

namespace voussoir::fem {

using Point = Eigen::Vector2d;            ///< [m]
using Coordinates = Eigen::Matrix2Xd;     ///< one column a node [m]
using ElementNodes = std::array<int, 8>;  ///< corners counter-clockwise, then midsides
using Edge = std::array<int, 3>;          ///< corner, mid, corner; walking along it the soil is on the left

struct Mesh {
  Coordinates coordinates;             ///< of the undeformed mesh [m]
  std::vector<ElementNodes> elements;  ///< Gauss point p of element e has the index 4 * e + p

  /// The outer edges of each named boundary, the soil on the left of each, as chains: an edge starts where the one
  /// before it ends. A boundary may have several pieces, one after the other, or be closed. All outer edges together
  /// run counter-clockwise around the soil and clockwise about a hole. Built-in shapes have "base" (x grows), "side" or
  /// "right" (y grows), "top" (x falls), "axis" or "left" (y falls) and "opening".
  std::map<std::string, std::vector<Edge>> edges;

  /// Outer edges on no named boundary.
  std::vector<Edge> unnamed_edges;

  /// The nodes of each named boundary in the order of its chain without repetition. A curve inside the ground has nodes
  /// but no edges.
  std::map<std::string, std::vector<int>> nodes;

  std::map<std::string, int> points;  ///< nodes with names, such as "crown" and "invert" of a tunnel

  std::vector<std::string> region_names;  ///< empty: all elements are of one region without a name
  std::vector<int> region;                ///< of each element, an index into region_names; empty as region_names is

  /// Non-zero for elements that have been dug out: they have neither stiffness nor weight. Empty: none has been.
  std::vector<char> dug_out;

  [[nodiscard]] int n_nodes() const { return static_cast<int>(coordinates.cols()); }
  [[nodiscard]] int n_elements() const { return static_cast<int>(elements.size()); }
  [[nodiscard]] int n_dofs() const { return 2 * n_nodes(); }
  [[nodiscard]] int n_points() const { return 4 * n_elements(); }

  [[nodiscard]] bool is_dug_out(int element) const { return !dug_out.empty() && dug_out[element] != 0; }

  /// True where the element is of the region with this name. Without names all elements are of one region, which then
  /// answers to any name.
  [[nodiscard]] bool in_region(int element, const std::string& name) const {
    return region_names.empty() || region_names[region[element]] == name;
  }
  /// True where the element is of one of the regions with these names.
  [[nodiscard]] bool in_region(int element, const std::vector<std::string>& names) const {
    return region_names.empty() || std::find(names.begin(), names.end(), region_names[region[element]]) != names.end();
  }

  /// The named boundary; throws std::out_of_range, whose message lists the names that exist.
  [[nodiscard]] const std::vector<Edge>& edge_set(const std::string& name) const;
  [[nodiscard]] const std::vector<int>& node_set(const std::string& name) const;
  /// The node with this name; throws std::out_of_range as the others.
  [[nodiscard]] int point(const std::string& name) const;
};

/// Area between a boundary chain and the line x = 0, or within a closed chain, integrated along the curved edges [m2].
/// It is positive where the soil is inside, so that the chain of the opening has minus the area of the (half) hole.
[[nodiscard]] double area_left_of(const Coordinates& coordinates, const std::vector<Edge>& chain);

}  // namespace voussoir::fem
