#include "fem/mesh_file_checks.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <numeric>
#include <set>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <unordered_set>

#include "fem/gauss_points.hpp"
#include "fem/mesh_grid.hpp"

namespace voussoir::fem {

namespace {

constexpr double glued_distance = 1e-9;  ///< over the mesh's extent

[[noreturn]] void refuse(const std::string& sentence) { throw std::runtime_error(sentence); }

std::string count_text(std::size_t n, const std::string& thing) {
  return std::to_string(n) + " " + thing + (n == 1 ? "" : "s");
}

std::string in_region(const GmshBlock& block) {
  return block.groups.empty() ? "" : " (the first in region " + block.groups.front() + ")";
}

double extent(const Coordinates& x) { return (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).maxCoeff(); }

/// The nodes that lie on another one, in the order of x and then y. Nodes are sorted by x; where x is equal up to
/// `near`, by y.
std::vector<int> double_nodes(const Coordinates& x, double near) {
  std::vector<int> order(x.cols());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return x(0, a) < x(0, b); });
  std::vector<int> found;
  for (auto first = order.begin(); first != order.end();) {
    auto last = first + 1;
    while (last != order.end() && x(0, *last) - x(0, *(last - 1)) <= near) ++last;
    std::sort(first, last, [&](int a, int b) { return x(1, a) < x(1, b); });
    for (auto k = first + 1; k < last; ++k)
      if ((x.col(*k) - x.col(*(k - 1))).norm() <= near) found.push_back(*k);
    first = last;
  }
  return found;
}

/// The corners of the outline that lie on an edge of the outline, between its ends.
std::vector<int> corners_on_edges(const Mesh& mesh, double near) {
  std::vector<Edge> outline = mesh.unnamed_edges;
  for (const auto& [name, chain] : mesh.edges) outline.insert(outline.end(), chain.begin(), chain.end());
  std::multimap<double, int> by_x;
  for (const Edge& edge : outline) by_x.emplace(mesh.coordinates(0, edge[0]), edge[0]);
  std::set<int> found;
  for (const Edge& edge : outline) {
    const Point a = mesh.coordinates.col(edge[0]);
    const Point along = mesh.coordinates.col(edge[2]) - a;
    const double length = along.norm();
    const auto last = by_x.upper_bound(std::max(a.x(), a.x() + along.x()) + near);
    for (auto k = by_x.lower_bound(std::min(a.x(), a.x() + along.x()) - near); k != last; ++k) {
      const Point to = mesh.coordinates.col(k->second) - a;
      const double at = to.dot(along) / length;
      const double beside = std::abs(to.x() * along.y() - to.y() * along.x()) / length;
      if (k->second != edge[0] && k->second != edge[2] && at > 0 && at < length && beside <= near)
        found.insert(k->second);
    }
  }
  return {found.begin(), found.end()};
}

void refuse_unglued(const Coordinates& x, const std::vector<int>& nodes, const char* where) {
  if (nodes.empty()) return;
  refuse(std::to_string(nodes.size()) + (nodes.size() == 1 ? " node lies" : " nodes lie") + where + " (first at " +
         place_text(x.col(nodes.front())) + "): the surfaces are not glued; in Gmsh: Coherence");
}

}  // namespace

std::string place_text(const Point& x) {
  std::ostringstream text;
  text << "(" << x.x() + 0.0 << ", " << x.y() + 0.0 << ")";
  return text.str();
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

void check_is_mesh(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  if (path.extension() != ".msh") refuse(name + " is no Gmsh mesh: its name does not end in .msh");
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse(name + " cannot be read: there is no such file, or it may not be read");
  std::string start(12, '\0');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  if (start != "$MeshFormat\n" && start != "$MeshFormat\r")
    refuse(name + " is no Gmsh mesh: its first line is not $MeshFormat");
  std::error_code none;
  if (std::filesystem::exists(path.string() + ".opt", none))
    refuse(name + ".opt lies beside the mesh, and Gmsh would run it as a script; move it away");
}

void check_nodes_of_version_2(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  std::getline(file, line);  // version, 0 for text, bytes of a number
  std::istringstream format(line);
  double version = 0;
  int is_binary = 1;
  if (!(format >> version >> is_binary) || version < 2 || version >= 3 || is_binary != 0) return;
  std::unordered_set<std::size_t> nodes;
  std::string section;
  while (std::getline(file, line)) {
    std::istringstream numbers(line);
    if (line.rfind('$', 0) == 0) numbers >> section;
    if (std::size_t tag = 0; section == "$Nodes" && numbers >> tag) nodes.insert(tag);
    std::size_t element = 0, type = 0, n_tags = 0, number = 0;
    if (section != "$Elements" || !(numbers >> element >> type >> n_tags)) continue;
    for (std::size_t k = 0; k < n_tags && numbers; ++k) numbers >> number;
    while (numbers >> number)
      if (nodes.count(number) == 0)
        refuse("element " + std::to_string(element) + " has the node " + std::to_string(number) +
               ", which the file lacks");
  }
}

void check_has_end(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file.tellg();
  const std::streamoff length = std::min<std::streamoff>(size, 200);
  std::string end(static_cast<std::size_t>(length), '\0');
  file.seekg(size - length);
  file.read(end.data(), length);
  end.erase(end.find_last_not_of(" \r\n\t") + 1);
  const std::string last_line = end.substr(end.find_last_of('\n') + 1);
  if (last_line.rfind("$End", 0) != 0)
    refuse(path.filename().string() + " cannot be read: it is cut off, since its last line does not begin with $End");
}

void check_shapes(const GmshFile& file) {
  std::map<std::string, std::size_t> count;
  std::size_t quadrilaterals = 0;
  for (const GmshBlock& block : file.blocks) {
    if (block.dimension == 3) refuse("there are solids (" + block.shape + "): the mesh must lie in the plane x-y");
    if (block.dimension == 2) count[block.shape] += block.tags.size();
  }
  for (const GmshBlock& block : file.blocks) {
    if (block.dimension != 2) continue;
    const std::size_t n = count[block.shape];
    if (block.shape.rfind("Triangle", 0) == 0)
      refuse(count_text(n, "triangle") + in_region(block) +
             ": only quadrilaterals of 4 or 8 nodes; in Gmsh: Mesh.RecombineAll = 1, Mesh.RecombinationAlgorithm = 2");
    if (block.shape.rfind("Quadrilateral", 0) != 0)
      refuse(count_text(n, "element") + " of the shape " + block.shape + in_region(block) +
             ": only quadrilaterals of 4 or 8 nodes");
    if (block.nodes_each != 4 && block.nodes_each != 8)
      refuse("quadrilaterals of " + std::to_string(block.nodes_each) + " nodes; in Gmsh: " +
             (block.nodes_each == 9 ? "" : "Mesh.ElementOrder = 2, ") + "Mesh.SecondOrderIncomplete = 1");
    quadrilaterals += block.tags.size();
  }
  if (quadrilaterals == 0) refuse("the file has no quadrilaterals");
  if (static_cast<double>(quadrilaterals) > max_elements) refuse("the mesh has more than two million elements");
}

void check_regions(const GmshFile& file) {
  if (file.groups[2].empty()) refuse("no physical surface: regions are named by physical surfaces");
  for (const GmshBlock& block : file.blocks) {
    if (block.dimension != 2) continue;
    const std::string first = "element " + std::to_string(block.tags.front());
    if (block.groups.size() > 1) refuse(first + " is in the regions " + block.groups[0] + " and " + block.groups[1]);
    if (block.groups.empty()) refuse(first + " is in no physical surface, while others are");
  }
}

void check_no_double_nodes(const Coordinates& nodes) {
  refuse_unglued(nodes, double_nodes(nodes, glued_distance * extent(nodes)), " on top of others");
}

void check_no_corner_on_edge(const Mesh& mesh) {
  const double near = glued_distance * extent(mesh.coordinates);
  refuse_unglued(mesh.coordinates, corners_on_edges(mesh, near), " on edges of other elements");
}

void check_folded(const Mesh& mesh, const std::vector<std::size_t>& tags) {
  const GaussPoints points = gauss_points(mesh, mesh.coordinates);
  for (int e = 0; e < mesh.n_elements(); ++e)
    for (int p = 0; p < 4; ++p)
      if (!(points.volumes[4 * e + p] > 0)) refuse("element " + std::to_string(tags[e]) + " is folded");
}

}  // namespace voussoir::fem
