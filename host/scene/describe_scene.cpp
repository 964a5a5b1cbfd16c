#include "host/scene/describe_scene.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "fem/gauss_points.hpp"
#include "host/scene/scene_checks.hpp"

namespace voussoir::host {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

struct Chain {
  double length = 0;  ///< [m]
  int pieces = 0;
};

Chain measure(const fem::Mesh& mesh, const std::vector<fem::Edge>& edges) {
  Chain chain;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const fem::Edge& edge = edges[k];
    if (k == 0 || edges[k - 1][2] != edge[0]) ++chain.pieces;
    chain.length += (mesh.coordinates.col(edge[1]) - mesh.coordinates.col(edge[0])).norm() +
                    (mesh.coordinates.col(edge[2]) - mesh.coordinates.col(edge[1])).norm();
  }
  return chain;
}

std::string mesh_line(const fem::Mesh& mesh) {
  const fem::Point size = mesh.coordinates.rowwise().maxCoeff() - mesh.coordinates.rowwise().minCoeff();
  double shortest = std::numeric_limits<double>::infinity();
  for (const fem::ElementNodes& element : mesh.elements) shortest = std::min(shortest, shortest_edge(mesh, element));
  return fmt::format("mesh: {} elements, {} nodes, {} points, {:.4g} x {:.4g} m; the shortest edge has {:.3g} m",
                     mesh.n_elements(), mesh.n_nodes(), mesh.n_points(), size.x(), size.y(), shortest);
}

std::string boundaries_line(const fem::Mesh& mesh) {
  std::vector<std::string> parts;
  for (const auto& [name, nodes] : mesh.nodes) {
    const std::vector<fem::Edge>& edges = outer_edges(mesh, name);
    if (edges.empty()) {
      parts.push_back(fmt::format("{} inside the ground ({} nodes)", name, nodes.size()));
      continue;
    }
    const Chain chain = measure(mesh, edges);
    parts.push_back(fmt::format("{} {:.4g} m ({} edge{}{})", name, chain.length, edges.size(),
                                edges.size() == 1 ? "" : "s",
                                chain.pieces > 1 ? fmt::format(" in {} pieces", chain.pieces) : ""));
  }
  if (!mesh.unnamed_edges.empty())
    parts.push_back(fmt::format("{:.4g} m without a name", measure(mesh, mesh.unnamed_edges).length));
  return fmt::format("boundaries: {}", fmt::join(parts, ", "));
}

struct Extent {
  double area = 0;  ///< [m2]
  int elements = 0;
};

Extent extent_of(const fem::Mesh& mesh, const fem::GaussPoints& points, const std::string& region) {
  Extent extent;
  for (int e = 0; e < mesh.n_elements(); ++e) {
    if (!mesh.in_region(e, region)) continue;
    ++extent.elements;
    for (int p = 4 * e; p < 4 * e + 4; ++p) extent.area += points.volumes[p];
  }
  return extent;
}

/// What is computed in a region.
std::string material_of(const Case& input, const RegionCase& region) {
  if (region.elastic) return fmt::format("linear elastic, {:.4g} MPa", region.elastic->modulus * 1e-6);
  if (input.material == MaterialKind::linear_elastic)
    return fmt::format("linear elastic, {:.4g} MPa", input.elastic.modulus * 1e-6);
  return fmt::format("grains, {} packing{} of {} grains", region.packing.variety,
                     region.packing.variety == 1 ? "" : "s", region.packing.grains);
}

std::vector<std::string> region_lines(const Case& input, const Scene& scene) {
  const fem::GaussPoints points = fem::gauss_points(scene.mesh, scene.mesh.coordinates);
  std::vector<std::string> lines;
  for (const RegionCase& region : scene.input.regions) {
    const std::string material = material_of(input, region);
    for (const std::string& name : region.names) {
      const auto [area, elements] = extent_of(scene.mesh, points, name);
      lines.push_back(fmt::format("region {}: {}; {:.4g} m2, {:.4g} kN/m, {} points", name, material, area,
                                  area * region.unit_weight * 1e-3, 4 * elements));
    }
  }
  return lines;
}

/// Where p0 acts, and how much ground would press as it does.
std::string pressure_line(const PlannedScene& planned) {
  const Scene& scene = planned.scene;
  std::vector<std::string> pressed;
  for (const BoundaryLoad& load : planned.plans.front().loads) {
    if (load.edges.empty() || (load.pressure_from[0] == 0 && load.pressure_from[1] == 0)) continue;
    pressed.push_back(fmt::format("{} ({:.4g} m)", load.boundary.empty() ? "edges without a name" : load.boundary,
                                  measure(scene.mesh, load.edges).length));
  }
  std::string line = fmt::format(
      "packing.pressure = {:.4g} kPa acts on {}", scene.pressure * 1e-3,
      pressed.empty() ? std::string("nothing") : fmt::format("{}", fmt::join(pressed, ", ")));
  double heaviest = 0;
  for (const RegionCase& region : scene.input.regions) heaviest = std::max(heaviest, region.unit_weight);
  if (heaviest == 0 || pressed.empty()) return line;
  const double height = scene.mesh.coordinates.row(1).maxCoeff() - scene.mesh.coordinates.row(1).minCoeff();
  const double depth = scene.pressure / heaviest;
  return line + fmt::format(": as much as {:.3g} m of ground, {:.2g} % of the height", depth, 100 * depth / height);
}

std::string motion_of(const Scene& scene, const Holder& holder, double end) {
  const MoveCase& move = holder.move;
  std::vector<std::string> parts;
  if (move.x || move.y)
    parts.push_back(fmt::format("by ({:.4g}, {:.4g}) m", move.x.value_or(0) * end, move.y.value_or(0) * end));
  if (move.rotation) parts.push_back(fmt::format("by {:.4g} deg", *move.rotation * end / degree));
  if (move.area) parts.push_back(fmt::format("its area changes by {:.4g} %", 100 * *move.area * end));
  return fmt::format("{} moves: {}", name_of(scene.mesh, holder), fmt::join(parts, ", "));
}

/// What holds, each once, even where a stage names again what is held.
std::string held_by(const Scene& scene, const StagePlan& plan) {
  std::vector<std::string> parts;
  for (const Holder& holder : plan.holders) {
    if (holder.nodes.empty()) continue;  // dug out
    std::string part = fmt::format("{} {}{}", name_of(scene.mesh, holder), holder.axes[0] ? "x" : "",
                                   holder.axes[1] ? "y" : "");
    if (std::find(parts.begin(), parts.end(), part) == parts.end()) parts.push_back(std::move(part));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

/// Who owns a degree of freedom of what is released: what holds it in this stage, or what else releases it.
std::string owner_of(const Scene& scene, const StagePlan& plan, int dof) {
  if (const auto owner = plan.owners.find(dof); owner != plan.owners.end())
    return name_of(scene.mesh, plan.holders[owner->second]);
  for (const ReleaseCase& release : plan.input.releases) {
    if (plan.released.at(target_of(scene.mesh, release)).own.contains(dof)) return name_of(scene.mesh, release);
  }
  return {};
}

/// "door is released by 50 %"; of a point, and of a boundary of which nothing fades, also whom its nodes belong to.
std::string release_words(const Scene& scene, const StagePlan& plan, const ReleaseCase& release) {
  const Released& released = plan.released.at(target_of(scene.mesh, release));
  const bool fades = std::any_of(released.own.begin(), released.own.end(),
                                 [&](int dof) { return plan.fading.contains(dof); });
  const std::string name = name_of(scene.mesh, release);
  std::string words = name + " is released";
  if (fades) words += fmt::format(" by {:.4g} %", 100 * release.share);
  if (fades && !release.boundary.empty()) return words;
  std::map<std::string, std::set<char>> axes;  // by the owner
  std::set<int> dofs = released.others;
  for (const int dof : released.own) {
    if (plan.owners.contains(dof)) dofs.insert(dof);  // a motion of this stage holds it
  }
  for (const int dof : dofs) axes[owner_of(scene, plan, dof)].insert(*axis_names[dof % 2]);
  for (const auto& [owner, named] : axes)
    words += fmt::format(", {} {} of its node{}", owner == name ? "a motion holds" : owner + " owns",
                         fmt::join(named, ""), release.boundary.empty() ? "" : "s");
  return fades || !axes.empty() ? words : words + ", all of it is dug out";
}

std::string stage_line(const Scene& scene, const StagePlan& plan, std::size_t number) {
  std::string line = fmt::format("stage {} {}: {} steps, {}; held: {}", number, plan.input.name, plan.targets.size(),
                                 plan.input.geometry == LossGeometry::fixed_mesh ? "fixed_mesh" : "updated_lagrangian",
                                 held_by(scene, plan));
  if (plan.gravity_from != plan.gravity_to)
    line += fmt::format("; the weights go from {:.4g} to {:.4g} of their full value", plan.gravity_from,
                        plan.gravity_to);
  if (plan.tilt_from != plan.tilt_to)
    line += fmt::format("; gravity turns from {:.4g} to {:.4g} deg", plan.tilt_from / degree, plan.tilt_to / degree);
  for (const PressCase& press : plan.input.presses) {
    line += press.kind == PressKind::pressure
                ? fmt::format("; {} is pressed by {:.4g} kPa", press.boundary, press.pressure * 1e-3)
            : press.kind == PressKind::traction ? fmt::format("; {} bears ({:.4g}, {:.4g}) kPa", press.boundary,
                                                              press.traction[0] * 1e-3, press.traction[1] * 1e-3)
                                                : fmt::format("; ground at rest presses on {}", press.boundary);
  }
  for (const ReleaseCase& release : plan.input.releases) line += "; " + release_words(scene, plan, release);
  for (const ExcavateCase& dug : plan.input.excavations) {
    for (const std::string& name : dug.regions) line += fmt::format("; {} is dug out", name);
  }
  for (const Holder& holder : plan.holders) {
    const double share = step_over_edge(scene, plan, holder);
    if (share > 0)
      line += fmt::format("; {}, {:.2g} of an element's edge a step{}", motion_of(scene, holder, plan.input.end), share,
                          share > wide_step ? ", which is much: more steps are safer" : "");
  }
  return line;
}

/// Nodes that several holders name on one axis, each pair of holders once.
std::vector<std::string> owner_lines(const Scene& scene, const StagePlan& plan) {
  struct Shared {
    std::vector<int> nodes;
    std::string axes;
  };
  std::map<std::pair<std::size_t, std::size_t>, Shared> shared;  // loser, owner
  for (std::size_t k = 0; k < plan.holders.size(); ++k) {
    const Holder& holder = plan.holders[k];
    for (int axis = 0; axis < 2; ++axis) {
      for (const int node : holder.nodes) {
        if (!holder.axes[axis]) continue;
        const std::size_t owner = plan.owners.at(2 * node + axis);
        const bool moved = plan.holders[owner].move.x || plan.holders[owner].move.y ||
                           plan.holders[owner].move.is_affine();
        if (!moved || plan.holders[owner].name == holder.name) continue;
        Shared& entry = shared[{k, owner}];
        if (std::find(entry.nodes.begin(), entry.nodes.end(), node) == entry.nodes.end()) entry.nodes.push_back(node);
        const char name = axis == 0 ? 'x' : 'y';
        if (entry.axes.find(name) == std::string::npos) entry.axes += name;
      }
    }
  }
  std::vector<std::string> lines;
  for (const auto& [pair, entry] : shared) {
    const fem::Point x = scene.mesh.coordinates.col(entry.nodes.front());
    lines.push_back(fmt::format("stage {}: {} (moved) owns {} before {} at {} node{}, the first at ({:.4g}, {:.4g}) m",
                                plan.input.name, name_of(scene.mesh, plan.holders[pair.second]), entry.axes,
                                name_of(scene.mesh, plan.holders[pair.first]), entry.nodes.size(),
                                entry.nodes.size() == 1 ? "" : "s", x.x(), x.y()));
  }
  return lines;
}

}  // namespace

std::vector<std::string> describe(const Case& input, const PlannedScene& planned) {
  const Scene& scene = planned.scene;
  std::vector<std::string> lines{mesh_line(scene.mesh), boundaries_line(scene.mesh)};
  for (std::string& line : region_lines(input, scene)) lines.push_back(std::move(line));
  lines.push_back(pressure_line(planned));
  for (std::size_t k = 0; k < planned.plans.size(); ++k) lines.push_back(stage_line(scene, planned.plans[k], k + 1));
  for (const StagePlan& plan : planned.plans) {
    for (std::string& line : owner_lines(scene, plan)) lines.push_back(std::move(line));
  }
  for (const std::string& remark : planned.remarks) lines.push_back(remark);
  return lines;
}

}  // namespace voussoir::host
