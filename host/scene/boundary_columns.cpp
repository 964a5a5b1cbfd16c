#include "host/scene/boundary_columns.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "fem/boundary.hpp"

namespace voussoir::host {
namespace {

constexpr std::array<const char*, 2> axis_names{"x", "y"};

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
      if (holder.move.area) boundaries.with_area.insert(holder.name);
      if (std::find(boundaries.held.begin(), boundaries.held.end(), holder.name) == boundaries.held.end())
        boundaries.held.push_back(holder.name);
    }
  }
  return boundaries;
}

std::map<std::string, int> tensile_nodes(const StagePlan& plan, const fem::Mesh& mesh, const Eigen::VectorXd& reactions,
                                         const fem::Coordinates& coordinates) {
  const double floor = 1e-6 * reactions.cwiseAbs().maxCoeff();
  std::map<std::string, int> found;
  std::map<std::string, Eigen::VectorXd> inwards;  // boundary -> integral of -N at its nodes
  for (const auto& [dof, owner] : plan.owners) {
    const Holder& holder = plan.holders[owner];
    if (!holder.is_boundary) continue;
    const auto [at, is_new] = inwards.try_emplace(holder.name);
    if (is_new) at->second = fem::pressure_force(coordinates, mesh.edge_set(holder.name), 1.0);
    if (dof % 2 == 1 && plan.owners.contains(dof - 1) && plan.owners.at(dof - 1) == owner) continue;  // counted with x
    fem::Point reaction = fem::Point::Zero();
    for (int k = 2 * (dof / 2); k < 2 * (dof / 2) + 2; ++k) {
      const auto same = plan.owners.find(k);
      if (same != plan.owners.end() && same->second == owner) reaction[k % 2] = reactions[k];
    }
    const fem::Point inward = at->second.segment<2>(2 * (dof / 2));
    if (inward.norm() > 0 && reaction.dot(inward) < -floor * inward.norm()) ++found[holder.name];
  }
  return found;
}

void add_boundary_columns(const WatchedBoundaries& boundaries, const StagePlan& plan, const Ground& ground,
                          const Eigen::VectorXd& reactions, const fem::Coordinates& coordinates, io::Quantities& to) {
  const Eigen::VectorXd displacement = ground.total_displacement();
  for (const std::string& name : boundaries.held) {
    const std::vector<fem::Edge>& edges = ground.mesh.edge_set(name);
    const Eigen::VectorXd width = widths(coordinates, edges);
    const fem::Point moved = mean_displacement(ground.mesh.node_set(name), displacement);
    for (int axis = 0; axis < 2; ++axis) {
      const Owned owned = owned_by(name, axis, plan, reactions, width);
      const std::string end = name + "_" + axis_names[axis];
      to["reaction_" + end] = {owned.reaction, "N/m"};
      to["displacement_" + end] = {moved[axis], "m"};
      if (!edges.empty()) to["traction_" + end] = {owned.width > 0 ? owned.reaction / owned.width : 0.0, "Pa"};
    }
    if (boundaries.with_area.contains(name)) to["area_" + name] = {lost_area(ground, name), "-"};
  }
  int pulled = 0;
  for (const auto& [name, count] : tensile_nodes(plan, ground.mesh, reactions, coordinates)) pulled += count;
  to["tensile_nodes"] = {static_cast<double>(pulled), "-"};
}

std::vector<std::string> column_names(const WatchedBoundaries& boundaries, const fem::Mesh& mesh) {
  std::vector<std::string> names;
  for (const std::string& name : boundaries.held) {
    for (const char* axis : axis_names) {
      names.push_back(fmt::format("reaction_{}_{}", name, axis));
      names.push_back(fmt::format("displacement_{}_{}", name, axis));
      if (!mesh.edge_set(name).empty()) names.push_back(fmt::format("traction_{}_{}", name, axis));
    }
    if (boundaries.with_area.contains(name)) names.push_back("area_" + name);
  }
  names.emplace_back("tensile_nodes");
  return names;
}

double lost_area(const Ground& ground, const std::string& boundary) {
  const std::vector<fem::Edge>& chain = ground.mesh.edge_set(boundary);
  const Eigen::VectorXd displacement = ground.total_displacement();
  fem::Coordinates moved = ground.mesh.coordinates;
  for (Eigen::Index node = 0; node < moved.cols(); ++node) moved.col(node) += displacement.segment<2>(2 * node);
  return 1.0 - fem::area_left_of(moved, chain) / fem::area_left_of(ground.mesh.coordinates, chain);
}

}  // namespace voussoir::host
