#include "fem/mesh_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <unordered_map>
#include <utility>

#include "fem/mesh_builder.hpp"
#include "fem/mesh_file_checks.hpp"
#include "fem/mesh_gmsh_file.hpp"
#include "fem/mesh_grid.hpp"
#include "fem/mesh_outline.hpp"

namespace voussoir::fem {

namespace {

constexpr double straight = 1e-9;  ///< a midside is off its edge's centre by at most this share of the edge
constexpr double in_plane = 1e-9;  ///< z over the extent of the mesh

[[noreturn]] void refuse(const std::string& sentence) { throw std::runtime_error(sentence); }

std::string plural(std::size_t n, const std::string& one, const std::string& more) {
  return std::to_string(n) + " " + (n == 1 ? one : more);
}

/// The nodes of a file by their tags.
class FileNodes {
 public:
  FileNodes(const GmshFile& file, double unit) : file_(file), unit_(unit) {
    for (std::size_t k = 0; k < file.node_tags.size(); ++k) index_.emplace(file.node_tags[k], k);
  }
  /// x and y of a node [m].
  [[nodiscard]] Point at(std::size_t tag) const {
    const double* x = position(tag);
    return {unit_ * x[0], unit_ * x[1]};
  }
  [[nodiscard]] double z(std::size_t tag) const { return position(tag)[2]; }
  [[nodiscard]] std::size_t size() const { return index_.size(); }

 private:
  [[nodiscard]] const double* position(std::size_t tag) const {
    const auto found = index_.find(tag);
    if (found == index_.end()) refuse("an element has the node " + std::to_string(tag) + ", which the file lacks");
    return &file_.positions[3 * found->second];
  }

  const GmshFile& file_;
  double unit_;
  std::unordered_map<std::size_t, std::size_t> index_;
};

/// A mesh under construction. Corners are numbered by ascending tag.
struct Draft {
  QuadMesh quads;
  std::vector<std::size_t> tags;          ///< of the elements in the file
  std::vector<std::size_t> corner_tags;   ///< ascending
  std::vector<std::string> region_names;  ///< of those that have elements, in the order of their tags
  std::vector<int> region;                ///< of each element
  std::size_t clockwise = 0, first_clockwise = 0, four_node = 0;
  std::map<CornerPair, std::string> curve_of;  ///< names of the edges on physical curves

  /// The corner with this tag, or none (-1).
  [[nodiscard]] int corner(std::size_t tag) const {
    const auto place = std::lower_bound(corner_tags.begin(), corner_tags.end(), tag);
    return place == corner_tags.end() || *place != tag ? -1 : static_cast<int>(place - corner_tags.begin());
  }
};

template <class Visit>
void for_elements(const GmshFile& file, int dimension, Visit&& visit) {
  for (const GmshBlock& block : file.blocks)
    if (block.dimension == dimension)
      for (std::size_t e = 0; e < block.tags.size(); ++e) visit(block, e, &block.nodes[e * block.nodes_each]);
}

/// The nodes of elements, by ascending tag; they are finite and in the plane.
std::vector<std::size_t> used_nodes(const GmshFile& file, const FileNodes& nodes) {
  std::set<std::size_t> used;
  for_elements(file, 2, [&](const GmshBlock& block, std::size_t, const std::size_t* of_element) {
    used.insert(of_element, of_element + block.nodes_each);
  });
  double largest = 0;
  for (const std::size_t tag : used) {
    const Point x = nodes.at(tag);
    if (!x.allFinite() || !std::isfinite(nodes.z(tag)))
      refuse("node " + std::to_string(tag) + " has a coordinate that is not finite");
    largest = std::max(largest, x.cwiseAbs().maxCoeff());
  }
  for (const std::size_t tag : used)
    if (std::abs(nodes.z(tag)) > in_plane * largest) {
      std::ostringstream text;
      text << "node " << tag << " has z = " << nodes.z(tag) << ": the mesh must lie in the plane x-y";
      refuse(text.str());
    }
  return {used.begin(), used.end()};
}

Coordinates positions_of(const std::vector<std::size_t>& tags, const FileNodes& nodes) {
  Coordinates x(2, static_cast<Eigen::Index>(tags.size()));
  for (std::size_t k = 0; k < tags.size(); ++k) x.col(static_cast<Eigen::Index>(k)) = nodes.at(tags[k]);
  return x;
}

/// Gmsh's order of a quadrilateral's nodes is that of ElementNodes. An element that is clockwise is turned round.
void add_element(const GmshBlock& block, std::size_t e, const std::size_t* of_element, const FileNodes& nodes,
                 Draft& draft) {
  Quad quad{};
  for (int k = 0; k < 4; ++k) quad[k] = draft.corner(of_element[k]);
  if (block.nodes_each == 4) ++draft.four_node;
  for (int k = 0; k < 4 && block.nodes_each == 8; ++k) {
    const Point a = nodes.at(of_element[k]);
    const Point b = nodes.at(of_element[(k + 1) % 4]);
    const Point middle = nodes.at(of_element[4 + k]);
    if ((middle - 0.5 * (a + b)).norm() > straight * (b - a).norm())
      draft.quads.midsides[corner_pair(quad[k], quad[(k + 1) % 4])] = middle;
  }
  const Point across = nodes.at(of_element[2]) - nodes.at(of_element[0]);
  const Point up = nodes.at(of_element[3]) - nodes.at(of_element[1]);
  if (across.x() * up.y() < across.y() * up.x()) {
    std::swap(quad[1], quad[3]);
    if (draft.clockwise++ == 0) draft.first_clockwise = block.tags[e];
  }
  draft.quads.quads.push_back(quad);
  draft.tags.push_back(block.tags[e]);
}

/// The names of `groups` of one dimension that are in `wanted`, in the order of their tags.
std::vector<std::string> in_order(const std::vector<std::string>& groups, const std::set<std::string>& wanted) {
  std::vector<std::string> names;
  for (const std::string& name : groups)
    if (wanted.count(name) > 0 && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  return names;
}

void add_elements(const GmshFile& file, const FileNodes& nodes, Draft& draft) {
  std::set<std::size_t> corners;
  std::set<std::string> regions;
  for_elements(file, 2, [&](const GmshBlock& block, std::size_t, const std::size_t* of_element) {
    corners.insert(of_element, of_element + 4);
    regions.insert(block.groups.front());
  });
  draft.region_names = in_order(file.groups[2], regions);
  draft.corner_tags.assign(corners.begin(), corners.end());
  draft.quads.corners = positions_of(draft.corner_tags, nodes);
  for_elements(file, 2, [&](const GmshBlock& block, std::size_t e, const std::size_t* of_element) {
    add_element(block, e, of_element, nodes, draft);
    const auto place = std::find(draft.region_names.begin(), draft.region_names.end(), block.groups.front());
    draft.region.push_back(static_cast<int>(place - draft.region_names.begin()));
  });
}

std::string edge_text(const Draft& draft, const CornerPair& edge) {
  return "the edge from " + place_text(draft.quads.corners.col(edge.first)) + " to " +
         place_text(draft.quads.corners.col(edge.second));
}

std::set<CornerPair> edges_of(const std::vector<Quad>& quads) {
  std::set<CornerPair> edges;
  for (const Quad& quad : quads)
    for (int k = 0; k < 4; ++k) edges.insert(corner_pair(quad[k], quad[(k + 1) % 4]));
  return edges;
}

/// Names the edges on physical curves, all of which must be edges of elements.
void add_curves(const GmshFile& file, Draft& draft) {
  const std::set<CornerPair> edges = edges_of(draft.quads.quads);
  std::size_t lost = 0;
  std::set<std::string> lost_names;
  for_elements(file, 1, [&](const GmshBlock& block, std::size_t, const std::size_t* of_element) {
    if (block.groups.empty()) return;
    const CornerPair edge = corner_pair(draft.corner(of_element[0]), draft.corner(of_element[1]));
    if (edges.count(edge) == 0) {
      ++lost;
      lost_names.insert(block.groups.begin(), block.groups.end());
      return;
    }
    for (const std::string& name : block.groups) {
      const auto [entry, is_new] = draft.curve_of.try_emplace(edge, name);
      if (entry->second != name)
        refuse(edge_text(draft, edge) + " is on the boundaries " + entry->second + " and " + name);
    }
  });
  if (lost == 0) return;
  refuse(plural(lost, "edge", "edges") + " of the boundaries " + joined(in_order(file.groups[1], lost_names)) +
         (lost == 1 ? " belongs" : " belong") +
         " to no element: Gmsh leaves out surfaces that are in no physical surface");
}

/// Gives the mesh the nodes of curves inside the ground, and says so.
void add_inner_curves(const Draft& draft, MeshFile& result) {
  std::map<std::string, std::vector<Edge>> inner;
  std::set<CornerPair> outer;
  for (const auto& [name, chain] : result.mesh.edges)
    for (const Edge& edge : chain) outer.insert(corner_pair(edge[0], edge[2]));
  if (outer.size() == draft.curve_of.size()) return;
  const std::map<CornerPair, int> midsides = midside_nodes(result.mesh);
  for (const auto& [edge, name] : draft.curve_of)
    if (outer.count(edge) == 0) inner[name].push_back({edge.first, midsides.at(edge), edge.second});
  for (const auto& [name, edges] : inner) {
    std::vector<int>& nodes = result.mesh.nodes[name];
    for (const int node : curve_nodes(edges))
      if (std::find(nodes.begin(), nodes.end(), node) == nodes.end()) nodes.push_back(node);
    result.remarks.push_back(plural(edges.size(), "edge", "edges") + " of the boundary " + name +
                             (edges.size() == 1 ? " lies" : " lie") +
                             " inside the ground: nodes there may be held or moved, but not pressed");
  }
}

/// The corners of each physical point by ascending tag, in the order of the points' groups.
void add_points(const GmshFile& file, const Draft& draft, MeshFile& result) {
  std::map<std::string, std::set<std::size_t>> nodes;
  for_elements(file, 0, [&](const GmshBlock& block, std::size_t, const std::size_t* of_element) {
    for (const std::string& name : block.groups) nodes[name].insert(*of_element);
  });
  for (const auto& [name, tags] : nodes) {
    int k = 0;
    std::vector<std::string> places;
    for (const std::size_t tag : tags) {
      const int corner = draft.corner(tag);
      if (corner < 0) refuse("the point " + name + " is a corner of no element");
      const std::string own = tags.size() == 1 ? name : name + "_" + std::to_string(++k);
      result.mesh.points[own] = corner;
      places.push_back(own + " at " + place_text(draft.quads.corners.col(corner)));
    }
    if (tags.size() > 1)
      result.remarks.push_back("the physical point " + name + " has " + std::to_string(tags.size()) +
                               " points: " + joined(places));
  }
}

void add_remarks(const Draft& draft, std::size_t unused, MeshFile& result) {
  std::vector<std::string>& remarks = result.remarks;
  if (draft.clockwise > 0)
    remarks.push_back(plural(draft.clockwise, "element was", "elements were") +
                      " clockwise and turned round (the first: element " + std::to_string(draft.first_clockwise) + ")");
  if (draft.four_node > 0)
    remarks.push_back(plural(draft.four_node, "element", "elements") +
                      " of 4 nodes completed to 8 nodes with straight edges");
  if (unused > 0) remarks.push_back(plural(unused, "node", "nodes") + " of no element left out");
  if (result.mesh.unnamed_edges.empty()) return;
  double length = 0;
  for (const Edge& edge : result.mesh.unnamed_edges)
    length += (result.mesh.coordinates.col(edge[2]) - result.mesh.coordinates.col(edge[0])).norm();
  std::ostringstream text;
  text << plural(result.mesh.unnamed_edges.size(), "outer edge", "outer edges") << " (" << length
       << " m) on no physical curve: the pressure of the packings acts there";
  remarks.push_back(text.str());
}

MeshFile mesh_of(const GmshFile& file, double unit) {
  check_shapes(file);
  const FileNodes nodes(file, unit);
  const std::vector<std::size_t> used = used_nodes(file, nodes);
  check_regions(file);
  Draft draft;
  add_elements(file, nodes, draft);
  add_curves(file, draft);
  check_no_double_nodes(positions_of(used, nodes));
  MeshFile result;
  result.mesh = complete_q8(draft.quads, [&](int a, int b) -> std::string {
    const auto curve = draft.curve_of.find(corner_pair(a, b));
    return curve == draft.curve_of.end() ? "" : curve->second;
  });
  set_layers(result.mesh, draft.region_names, draft.region);
  check_no_corner_on_edge(result.mesh);
  check_folded(result.mesh, draft.tags);
  add_remarks(draft, nodes.size() - used.size(), result);
  add_inner_curves(draft, result);
  add_points(file, draft, result);
  return result;
}

GmshFile read_file(const std::filesystem::path& path, double seconds) {
  try {
    return read_gmsh_file(path, seconds);
  } catch (const std::runtime_error& fault) {
    refuse(path.filename().string() + " cannot be read: " + fault.what());
  }
}

}  // namespace

MeshFile read_mesh_file(const std::filesystem::path& path, double unit, double seconds) {
  check_is_mesh(path);
  check_nodes_of_version_2(path);
  const GmshFile file = read_file(path, seconds);
  check_has_end(path);
  return mesh_of(file, unit);
}

}  // namespace voussoir::fem
