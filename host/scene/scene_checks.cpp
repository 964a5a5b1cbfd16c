#include "host/scene/scene_checks.hpp"

#include <spdlog/fmt/fmt.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <stdexcept>

namespace voussoir::host {
namespace {

constexpr std::array<const char*, 2> axis_names{"x", "y"};

[[noreturn]] void refuse(const std::string& key, const std::string& sentence) {
  throw std::runtime_error(fmt::format("{}: {}", key, sentence));
}

void check_node(const Scene& scene, const std::string& key, const PlaceCase& point) {
  if (node_at(scene.mesh, point) >= 0) return;
  refuse(key, fmt::format("no node of the mesh lies at ({:.6g}, {:.6g}) m", point.at[0], point.at[1]));
}

void check_press(const Scene& scene, const StagePlan& plan, const PressCase& press, const std::string& key) {
  if (scene.mesh.edge_set(press.boundary).empty())
    refuse(key + ".boundary", press.boundary + " lies inside the ground: it may be held or moved, but not pressed");
  for (const Holder& holder : plan.holders) {
    if (!holder.is_boundary || holder.name != press.boundary) continue;
    for (int axis = 0; axis < 2; ++axis) {
      const bool acts = press.kind == PressKind::traction
                            ? press.traction[axis] != 0
                            : faces(scene.mesh, scene.mesh.edge_set(press.boundary), axis);
      if (holder.axes[axis] && acts)
        refuse(key + ".boundary",
               fmt::format("{} is held along {}: move or release it", press.boundary, axis_names[axis]));
    }
  }
}

/// The first and the last node of a boundary in one piece; the same node twice where it is closed.
std::array<int, 2> ends_of(const std::vector<fem::Edge>& chain) { return {chain.front()[0], chain.back()[2]}; }

/// A boundary that changes its area is closed, or its ends stay on supports.
void check_area(const Scene& scene, const StagePlan& plan, const Holder& moved, const std::string& key) {
  const std::vector<fem::Edge>& chain = scene.mesh.edge_set(moved.name);
  const auto refused = [&] {
    refuse(key + ".area", moved.name + " is neither closed nor ends on supports through its point");
  };
  if (chain.empty()) refused();
  for (std::size_t k = 1; k < chain.size(); ++k) {
    if (chain[k][0] != chain[k - 1][2]) refused();
  }
  const std::array<int, 2> ends = ends_of(chain);
  if (ends[0] == ends[1]) return;
  for (const int node : ends) {
    const fem::Point way = moved.displacement(scene.mesh.coordinates.col(node), 0, plan.input.end);
    bool supported = false;
    for (const Holder& holder : plan.holders) {
      if (&holder == &moved || std::find(holder.nodes.begin(), holder.nodes.end(), node) == holder.nodes.end())
        continue;
      for (int axis = 0; axis < 2; ++axis) {
        if (!holder.axes[axis]) continue;
        supported = true;
        if (std::abs(way[axis]) > 1e-9 * (1 + way.norm())) refused();
      }
    }
    if (!supported) refused();
  }
}

/// Rigid motions that the held degrees of freedom leave: along x, along y, rotation.
void check_held(const Scene& scene, const StagePlan& plan, const std::string& key) {
  const fem::Point centre = scene.mesh.coordinates.rowwise().mean();
  const double size = (scene.mesh.coordinates.colwise() - centre).colwise().norm().maxCoeff();
  Eigen::Matrix3d gram = Eigen::Matrix3d::Zero();
  for (const auto& [dof, owner] : plan.owners) {
    const fem::Point arm = (fem::Point(scene.mesh.coordinates.col(dof / 2)) - centre) / size;
    const Eigen::Vector3d row = dof % 2 == 0 ? Eigen::Vector3d(1, 0, -arm.y()) : Eigen::Vector3d(0, 1, arm.x());
    gram += row * row.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> modes(gram);
  if (modes.eigenvalues()[0] > 1e-9) return;
  const Eigen::Vector3d free = modes.eigenvectors().col(0).cwiseAbs();
  Eigen::Index most = 0;
  free.maxCoeff(&most);
  refuse(key, most == 2 ? "nothing keeps the ground from turning"
                        : fmt::format("nothing holds the ground along {}", axis_names[most]));
}

double shortest_edge_at(const fem::Mesh& mesh, const std::vector<int>& nodes) {
  const std::set<int> wanted(nodes.begin(), nodes.end());
  double shortest = std::numeric_limits<double>::infinity();
  for (const fem::ElementNodes& element : mesh.elements) {
    if (std::none_of(element.begin(), element.end(), [&](int node) { return wanted.contains(node); })) continue;
    for (int k = 0; k < 4; ++k) {
      const fem::Point along = mesh.coordinates.col(element[(k + 1) % 4]) - mesh.coordinates.col(element[k]);
      shortest = std::min(shortest, along.norm());
    }
  }
  return shortest;
}

}  // namespace

bool faces(const fem::Mesh& mesh, const std::vector<fem::Edge>& edges, int axis) {
  return std::any_of(edges.begin(), edges.end(), [&](const fem::Edge& edge) {
    const fem::Point along = mesh.coordinates.col(edge[2]) - mesh.coordinates.col(edge[0]);
    return std::abs(along[1 - axis]) > 1e-9 * along.norm();
  });
}

double step_over_edge(const Scene& scene, const StagePlan& plan, const Holder& holder) {
  double longest = 0, before = 0;
  for (const double target : plan.targets) {
    for (const int node : holder.nodes) {
      longest = std::max(longest, holder.displacement(scene.mesh.coordinates.col(node), before, target).norm());
    }
    before = target;
  }
  return longest > 0 ? longest / shortest_edge_at(scene.mesh, holder.nodes) : 0.0;
}

void check_places(const Scene& scene) {
  for (std::size_t k = 0; k < scene.input.supports.size(); ++k) {
    const SupportCase& support = scene.input.supports[k];
    if (support.boundaries.empty()) check_node(scene, fmt::format("support[{}].point", k), support.point);
  }
  for (std::size_t s = 0; s < scene.input.stages.size(); ++s) {
    const std::vector<MoveCase>& moves = scene.input.stages[s].moves;
    for (std::size_t k = 0; k < moves.size(); ++k) {
      if (moves[k].boundary.empty()) check_node(scene, fmt::format("stage[{}].move[{}].point", s, k), moves[k].point);
    }
  }
}

void check_stage(const Scene& scene, const StagePlan& plan, std::size_t number) {
  const std::string key = fmt::format("stage[{}]", number);
  for (std::size_t k = 0; k < plan.input.presses.size(); ++k) {
    check_press(scene, plan, plan.input.presses[k], fmt::format("{}.press[{}]", key, k));
  }
  const std::size_t first_move = plan.holders.size() - plan.input.moves.size();
  for (std::size_t k = 0; k < plan.input.moves.size(); ++k) {
    const Holder& moved = plan.holders[first_move + k];
    if (moved.move.area && moved.is_boundary) check_area(scene, plan, moved, fmt::format("{}.move[{}]", key, k));
  }
  check_held(scene, plan, number == 0 ? "support" : key);
}

void check_steps(const Scene& scene, const StagePlan& plan, std::size_t number) {
  for (const Holder& holder : plan.holders) {
    const double share = step_over_edge(scene, plan, holder);
    if (share > most_of_an_edge)
      refuse(fmt::format("stage[{}].steps", number),
             fmt::format("{} moves by {:.2g} of an element's edge a step: more steps", holder.name, share));
  }
}

}  // namespace voussoir::host
