#include "host/scene/boundary_columns.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "fem/boundary.hpp"
#include "fem/mesh_outline.hpp"

namespace voussoir::host {
namespace {

/// Sums over what the holders of a boundary own, along one axis.
struct Owned {
  double reaction = 0;  ///< [N/m]
  double width = 0;     ///< integral of the shape functions of the owned nodes [m]
};

Owned owned_by(const std::string& boundary, int axis, const StagePlan& plan, const Eigen::VectorXd& reactions,
               const Eigen::VectorXd& width_of_node) {
  Owned owned;
  for (const auto& [dof, owner] : plan.owners) {
    const Holder& holder = plan.holders[owner];
    if (!holder.is_boundary || holder.name != boundary || dof % 2 != axis) continue;
    owned.reaction += reactions[dof];
    owned.width += width_of_node[dof / 2];
  }
  return owned;
}

/// The integral of each node's shape function along the edges, n_nodes [m].
Eigen::VectorXd widths(const fem::Coordinates& coordinates, const std::vector<fem::Edge>& edges) {
  const Eigen::VectorXd along = fem::constant_traction_force(coordinates, edges, {1.0, 0.0});
  Eigen::VectorXd width(coordinates.cols());
  for (Eigen::Index node = 0; node < width.size(); ++node) width[node] = along[2 * node];
  return width;
}

/// The outer edges of a boundary at elements that are left.
std::vector<fem::Edge> edges_left(const StagePlan& plan, const std::string& boundary) {
  const BoundaryLoad* load = plan.load_of(boundary);
  return load == nullptr ? std::vector<fem::Edge>{} : load->edges;
}

/// The edges of a boundary, and those of others that go on from its ends in the same direction and are held along the
/// axis, too: the reaction of a node at its end carries the ground on both sides.
std::vector<fem::Edge> edges_carried(const StagePlan& plan, const fem::Coordinates& coordinates,
                                     const std::string& boundary, int axis) {
  constexpr double same_direction = 0.87;  // 30 deg
  std::vector<fem::Edge> edges = edges_left(plan, boundary);
  const std::vector<fem::Edge> own = edges;
  const auto direction = [&](const fem::Edge& edge) -> fem::Point {
    return (coordinates.col(edge[2]) - coordinates.col(edge[0])).normalized();
  };
  std::set<std::string> others;
  for (const Holder& holder : plan.holders) {
    if (holder.is_boundary && holder.axes[axis] && holder.name != boundary) others.insert(holder.name);
  }
  for (const std::string& other : others) {
    for (const fem::Edge& edge : edges_left(plan, other)) {
      const bool goes_on = std::any_of(own.begin(), own.end(), [&](const fem::Edge& one) {
        return (one[2] == edge[0] || edge[2] == one[0]) && direction(one).dot(direction(edge)) > same_direction;
      });
      if (goes_on) edges.push_back(edge);
    }
  }
  return edges;
}

/// The outer edges along a boundary, or at a point.
std::vector<fem::Edge> edges_at(const fem::Mesh& mesh, const Target& target, const std::vector<fem::Edge>& outline) {
  std::set<int> along;
  if (!target.boundary.empty()) {
    const std::vector<int>& nodes = mesh.node_set(target.boundary);
    along.insert(nodes.begin(), nodes.end());
  }
  std::vector<fem::Edge> edges;
  for (const fem::Edge& edge : outline) {
    const bool is_at = target.boundary.empty() ? std::find(edge.begin(), edge.end(), target.node) != edge.end()
                                               : along.contains(edge[1]);
    if (is_at) edges.push_back(edge);
  }
  return edges;
}

/// Its nodes at elements that are left.
std::vector<int> nodes_left(const StagePlan& plan, std::vector<int> nodes) {
  const std::set<int> idle(plan.idle_nodes.begin(), plan.idle_nodes.end());
  std::erase_if(nodes, [&](int node) { return idle.contains(node); });
  return nodes;
}

fem::Point mean_displacement(const std::vector<int>& nodes, const Eigen::VectorXd& displacement) {
  fem::Point mean = fem::Point::Zero();
  for (const int node : nodes) mean += displacement.segment<2>(2 * node) / static_cast<double>(nodes.size());
  return mean;
}

}  // namespace

WatchedBoundaries watched(const std::vector<StagePlan>& plans) {
  WatchedBoundaries boundaries;
  for (const StagePlan& plan : plans) {
    for (const Holder& holder : plan.holders) {
      if (!holder.is_boundary) continue;
      if (holder.move.area) boundaries.with_area.try_emplace(holder.name, holder.about);
      if (std::find(boundaries.held.begin(), boundaries.held.end(), holder.name) == boundaries.held.end())
        boundaries.held.push_back(holder.name);
    }
  }
  return boundaries;
}

NodesByName tensile_nodes(const fem::Mesh& mesh, const StagePlan& plan, const Eigen::VectorXd& reactions,
                          const fem::Coordinates& coordinates) {
  std::map<Target, std::map<int, fem::Point>> owned;  // node -> its reaction
  std::map<Target, std::string> names;
  for (const auto& [dof, owner] : plan.owners) {
    const Holder& holder = plan.holders[owner];
    const Target target = holder.target();
    owned[target].try_emplace(dof / 2, fem::Point::Zero()).first->second[dof % 2] = reactions[dof];
    names.try_emplace(target, name_of(mesh, holder));
  }
  const double floor = 1e-6 * reactions.cwiseAbs().maxCoeff();
  const std::vector<fem::Edge> outline = fem::outline_of(mesh, plan.dug_out);
  NodesByName found;
  for (const auto& [target, nodes] : owned) {
    const Eigen::VectorXd inwards = fem::pressure_force(coordinates, edges_at(mesh, target, outline), 1.0);  // of -N
    for (const auto& [node, reaction] : nodes) {
      const fem::Point inward = inwards.segment<2>(2 * node);
      if (inward.norm() > 0 && reaction.dot(inward) < -floor * inward.norm()) found[names.at(target)].insert(node);
    }
  }
  return found;
}

void add_boundary_columns(const WatchedBoundaries& boundaries, const StagePlan& plan, const Ground& ground,
                          const Eigen::VectorXd& reactions, const fem::Coordinates& coordinates,
                          const NodesByName& pulled, io::Quantities& to) {
  const Eigen::VectorXd displacement = ground.total_displacement();
  for (const std::string& name : boundaries.held) {
    const std::vector<int> nodes = nodes_left(plan, ground.mesh.node_set(name));
    if (nodes.empty()) continue;
    const bool is_outside = !edges_left(plan, name).empty();
    const fem::Point moved = mean_displacement(nodes, displacement);
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::VectorXd width = widths(coordinates, edges_carried(plan, coordinates, name, axis));
      const Owned owned = owned_by(name, axis, plan, reactions, width);
      const std::string end = name + "_" + axis_names[axis];
      to["reaction_" + end] = {owned.reaction, "N/m"};
      to["displacement_" + end] = {moved[axis], "m"};
      if (is_outside) to["traction_" + end] = {owned.width > 0 ? owned.reaction / owned.width : 0.0, "Pa"};
    }
    const auto area = boundaries.with_area.find(name);
    if (area != boundaries.with_area.end()) to["area_" + name] = {lost_area(ground, name, area->second), "-"};
  }
  std::set<int> once;
  for (const auto& [name, nodes] : pulled) once.insert(nodes.begin(), nodes.end());
  to["tensile_nodes"] = {static_cast<double>(once.size()), "-"};
}

std::vector<std::string> column_names(const WatchedBoundaries& boundaries, const fem::Mesh& mesh) {
  std::vector<std::string> names;
  for (const std::string& name : boundaries.held) {
    for (const char* axis : axis_names) {
      names.push_back(fmt::format("reaction_{}_{}", name, axis));
      names.push_back(fmt::format("displacement_{}_{}", name, axis));
      if (!outer_edges(mesh, name).empty()) names.push_back(fmt::format("traction_{}_{}", name, axis));
    }
    if (boundaries.with_area.contains(name)) names.push_back("area_" + name);
  }
  names.emplace_back("tensile_nodes");
  return names;
}

double lost_area(const Ground& ground, const std::string& boundary, const fem::Point& about) {
  const std::vector<fem::Edge>& chain = ground.mesh.edge_set(boundary);
  const Eigen::VectorXd displacement = ground.total_displacement();
  const fem::Coordinates drawn = ground.mesh.coordinates.colwise() - about;
  fem::Coordinates moved = drawn;
  for (Eigen::Index node = 0; node < moved.cols(); ++node) moved.col(node) += displacement.segment<2>(2 * node);
  return 1.0 - fem::area_left_of(moved, chain) / fem::area_left_of(drawn, chain);
}

}  // namespace voussoir::host
