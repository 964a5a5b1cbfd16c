#include "host/ensemble/member.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <concepts>
#include <limits>
#include <set>
#include <span>
#include <stdexcept>
#include <string_view>

#include "host/ensemble/trough_fit.hpp"
#include "io/increment_file.hpp"

namespace voussoir::host {
namespace {

constexpr std::size_t corners = 4;     ///< Gauss points of an element
constexpr std::size_t node_count = 8;  ///< nodes of an element

/// Nodes of a boundary; nullptr where the mesh has no such boundary.
const std::vector<std::int64_t>* boundary(const io::MeshData& mesh, const std::string& name) {
  const auto found = std::find_if(mesh.boundaries.begin(), mesh.boundaries.end(),
                                  [&](const auto& entry) { return entry.first == name; });
  return found == mesh.boundaries.end() ? nullptr : &found->second;
}

/// The nodes of the surface from the axis x = 0 outwards; none where they are too few for a curve.
std::vector<std::size_t> surface_nodes(const io::MeshData& mesh) {
  std::vector<std::size_t> nodes;
  if (const auto* top = boundary(mesh, "top")) nodes.assign(top->begin(), top->end());
  std::erase_if(nodes, [&](std::size_t node) { return mesh.coordinates[2 * node] < 0; });
  std::sort(nodes.begin(), nodes.end(),
            [&](std::size_t a, std::size_t b) { return mesh.coordinates[2 * a] < mesh.coordinates[2 * b]; });
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  if (nodes.size() < 4) nodes.clear();
  return nodes;
}

/// The element just above the crown: of those that hold the crown's node, the one whose nodes lie highest in the mean.
std::optional<std::size_t> crown_element(const io::MeshData& mesh) {
  const auto* opening = boundary(mesh, "tunnel");
  if (opening == nullptr || opening->empty()) return std::nullopt;
  const auto height = [&](std::int64_t node) { return mesh.coordinates[2 * static_cast<std::size_t>(node) + 1]; };
  const std::int64_t crown = *std::max_element(opening->begin(), opening->end(),
                                               [&](std::int64_t a, std::int64_t b) { return height(a) < height(b); });
  std::optional<std::size_t> found;
  double highest = -std::numeric_limits<double>::infinity();
  for (std::size_t element = 0; element < mesh.elements(); ++element) {
    const auto nodes = std::span(mesh.connectivity).subspan(node_count * element, node_count);
    if (std::find(nodes.begin(), nodes.end(), crown) == nodes.end()) continue;
    double sum = 0;
    for (const std::int64_t node : nodes) sum += height(node);
    if (sum > highest) highest = sum, found = element;
  }
  return found;
}

/// The vertical stress of an element, the mean of its points, compression positive [Pa].
double vertical_stress(const io::Field& stress, std::size_t element) {
  double sum = 0;
  for (std::size_t point = 0; point < corners; ++point) sum -= stress.values[3 * (corners * element + point) + 1];
  return sum / corners;
}

void add_trough(MemberResults& member, std::size_t increment, double axis_depth) {
  const std::vector<double>& settlement = member.settlement[increment];
  const TroughFit fit = fit_trough(member.surface_x, settlement);
  const std::array<io::Quantity, trough_columns.size()> values{{{fit.largest, "m"},
                                                                {fit.inflection, "m"},
                                                                {fit.alpha, "-"},
                                                                {fit.inflection / axis_depth, "-"},
                                                                {fit.misfit, "-"}}};
  for (std::size_t k = 0; k < values.size(); ++k) member.increments[increment].extra[trough_columns[k]] = values[k];
  member.good_trough[increment] = fit.good();
}

/// Adds what the fields of the volume loss show: troughs, and the stress above the crown over its value at V_l = 0.
void add_field_columns(MemberResults& member) {
  const std::vector<std::size_t> nodes = surface_nodes(member.mesh);
  const std::optional<std::size_t> crown = crown_element(member.mesh);
  const auto depth = member.mesh.geometry.find("axis_depth");
  std::optional<double> at_start;
  double least = 1;
  for (std::size_t k = 0; k < member.increments.size(); ++k) {
    io::IncrementInfo& info = member.increments[k];
    if (info.stage != "volume_loss") continue;
    const auto path = io::increment_path(member.folder, info.index);
    const auto moved = io::find_field(path, io::FieldLocation::node, "displacement");
    if (moved && !nodes.empty() && depth != member.mesh.geometry.end()) {
      if (member.surface_x.empty())
        for (const std::size_t node : nodes) member.surface_x.push_back(member.mesh.coordinates[2 * node]);
      for (const std::size_t node : nodes) member.settlement[k].push_back(0.0 - moved->values.at(2 * node + 1));
      if (info.load_parameter > 0) add_trough(member, k, depth->second);
    }
    const auto stress = io::find_field(path, io::FieldLocation::gauss, "stress");
    if (!stress || !crown) continue;
    const double vertical = vertical_stress(*stress, *crown);
    if (info.load_parameter == 0) at_start = vertical;
    if (!at_start || !(*at_start > 0)) continue;
    least = std::min(least, vertical / *at_start);
    info.extra[reaction_columns[0]] = {vertical / *at_start, "-"};
    info.extra[reaction_columns[1]] = {least, "-"};
  }
}

}  // namespace

bool is_at_end(const Case& input, const std::vector<io::IncrementInfo>& increments) {
  if (increments.empty()) return false;
  const io::IncrementInfo& last = increments.back();
  switch (input.kind) {
    case CaseKind::tunnel:
      return last.stage == "volume_loss" && last.stage_index == input.volume_loss.increments;
    case CaseKind::column:
      return last.load_parameter == 1;
    case CaseKind::biaxial_bvp:
      return last.stage_index == input.biaxial_bvp.increments();
    case CaseKind::scene:
      return last.stage == input.scene.stages.back().name && last.load_parameter == input.scene.stages.back().end;
    default:
      return false;
  }
}

MemberResults read_member(const std::filesystem::path& folder) {
  const std::filesystem::path index = folder / "run.h5";
  MemberResults member{.folder = folder,
                       .mesh = io::read_mesh(index),
                       .increments = io::read_increments(index),
                       .tables = io::read_tables(index)};
  if (member.increments.empty())
    throw std::runtime_error(fmt::format("{}: the finished run has no increments", folder.string()));
  member.tables.erase("gauss_histories");  // as long as all points of all increments, which the fields hold
  member.settlement.resize(member.increments.size());
  member.good_trough.resize(member.increments.size(), false);
  add_field_columns(member);
  return member;
}

io::Quantities results_of(const io::IncrementInfo& increment) {
  static const std::set<std::string_view> none{"index",     "stage_index", "load_parameter", "volume_loss",
                                               "converged", "wall_s",      "slowest_point",  "peak_memory"};
  io::Quantities found;
  io::for_each_number(increment, [&](const char* name, const char* unit, auto value) {
    if (!none.contains(name)) found[name] = {static_cast<double>(value), unit};
  });
  for (const auto& [name, quantity] : increment.extra) {
    if (!none.contains(name) && !name.starts_with("time_")) found[name] = quantity;
  }
  return found;
}

std::optional<double> value_of(const io::IncrementInfo& increment, const std::string& column) {
  const io::Quantities all = results_of(increment);
  const auto found = all.find(column);
  return found == all.end() ? std::nullopt : std::optional(found->second.value);
}

}  // namespace voussoir::host
