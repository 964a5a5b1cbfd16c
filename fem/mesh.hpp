#pragma once
/// Meshes of eight-node quadrilaterals (Q8, serendipity) and their named boundaries.
///
/// Origin at the base on the symmetry axis, x to the right, y up, metres. Element nodes: corners 0-3 counter-clockwise,
/// then the midsides 4 (0-1), 5 (1-2), 6 (2-3), 7 (3-0). Degree of freedom 2*node is u_x, 2*node + 1 is u_y.

#include <Eigen/Dense>
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

  /// Boundaries as chains, each edge starting where the one before it ends; all chains together run counter-clockwise
  /// around the soil: "base" (x grows), "side" (y grows), "top" (x falls), "axis" (x = 0, y falls; with a tunnel in two
  /// pieces, above the crown and below the invert) and "opening" (from crown to invert, clockwise about its centre).
  std::map<std::string, std::vector<Edge>> edges;

  /// Every boundary of `edges` under its name, in the order of its chain without repetition; with a tunnel "crown" and
  /// "invert" (one node each).
  std::map<std::string, std::vector<int>> nodes;

  [[nodiscard]] int n_nodes() const { return static_cast<int>(coordinates.cols()); }
  [[nodiscard]] int n_elements() const { return static_cast<int>(elements.size()); }
  [[nodiscard]] int n_dofs() const { return 2 * n_nodes(); }
  [[nodiscard]] int n_points() const { return 4 * n_elements(); }

  /// The named boundary; throws std::out_of_range, whose message lists the names that exist.
  [[nodiscard]] const std::vector<Edge>& edge_set(const std::string& name) const;
  [[nodiscard]] const std::vector<int>& node_set(const std::string& name) const;
};

/// Area between a boundary chain and the line x = 0, or within a closed chain, integrated along the curved edges [m2].
/// It is positive where the soil is inside, so that the chain of the opening has minus the area of the (half) hole.
[[nodiscard]] double area_left_of(const Coordinates& coordinates, const std::vector<Edge>& chain);

}  // namespace voussoir::fem
