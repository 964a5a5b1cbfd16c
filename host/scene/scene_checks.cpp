#include "host/scene/scene_checks.hpp"

#include <spdlog/fmt/fmt.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>

namespace voussoir::host {
namespace {

[[noreturn]] void refuse(const std::string& key, const std::string& sentence) {
  throw std::runtime_error(fmt::format("{}: {}", key, sentence));
}

void check_node(const Scene& scene, const std::string& key, const PlaceCase& point) {
  if (node_at(scene.mesh, point) >= 0) return;
  refuse(key, fmt::format("no node of the mesh lies at ({:.6g}, {:.6g}) m", point.at[0], point.at[1]));
}

void check_press(const Scene& scene, const StagePlan& plan, const PressCase& press, const std::string& key) {
  const BoundaryLoad* load = plan.load_of(press.boundary);
  if (load->edges.empty()) refuse(key + ".boundary", fmt::format("all of {} has been dug out", press.boundary));
  for (const Holder& holder : plan.holders) {
    if (!holder.is_boundary || holder.name != press.boundary) continue;
    for (int axis = 0; axis < 2; ++axis) {
      const bool acts = press.kind == PressKind::traction ? press.traction[axis] != 0
                                                          : faces(scene.mesh, load->edges, axis);
      if (holder.axes[axis] && acts)
        refuse(key + ".boundary",
               fmt::format("{} is held along {}: move or release it", press.boundary, axis_names[axis]));
    }
  }
}

/// Tractions of ground at rest are those of level ground that nobody has dug in.
void check_at_rest(const StagePlan& plan, const std::string& key) {
  for (const BoundaryLoad& load : plan.loads) {
    if (load.edges.empty() || (load.rest_to[0] == 0 && load.rest_to[1] == 0)) continue;
    if (plan.tilt_from != 0 || plan.tilt_to != 0)
      refuse(key + (plan.input.tilt ? ".tilt" : ".press"),
             fmt::format("{} is pressed by ground at rest, which is level, but gravity is tilted", load.boundary));
  }
  for (std::size_t k = 0; k < plan.input.presses.size(); ++k) {
    const bool has_holes = std::any_of(plan.dug_out.begin(), plan.dug_out.end(), [](char dug) { return dug != 0; });
    if (plan.input.presses[k].kind == PressKind::at_rest && has_holes)
      refuse(fmt::format("{}.press[{}].at_rest", key, k),
             "ground was dug out before, so that what is left is not at rest");
  }
}

/// Each region is dug out once, and some ground is left.
void check_excavations(const Scene& scene) {
  std::set<std::string> left(scene.mesh.region_names.begin(), scene.mesh.region_names.end());
  std::set<std::string> gone;
  for (std::size_t s = 0; s < scene.input.stages.size(); ++s) {
    const std::vector<ExcavateCase>& excavations = scene.input.stages[s].excavations;
    for (std::size_t k = 0; k < excavations.size(); ++k) {
      const std::string key = fmt::format("stage[{}].excavate[{}].region", s, k);
      for (const std::string& name : excavations[k].regions) {
        if (gone.contains(name)) refuse(key, name + " has been dug out before");
        if (left.erase(name) == 0) refuse(key, "the mesh has no region " + name);
        if (left.empty()) refuse(key, "nothing of the ground is left");
        gone.insert(name);
      }
    }
  }
}

/// The first and the last node of a boundary in one piece; the same node twice where it is closed.
std::array<int, 2> ends_of(const std::vector<fem::Edge>& chain) { return {chain.front()[0], chain.back()[2]}; }

/// Whether a node of a moved boundary is held by something else, which moves along with it.
bool stays_on_supports(const Scene& scene, const StagePlan& plan, const Holder& moved, int node) {
  const fem::Point x = scene.mesh.coordinates.col(node);
  const fem::Point way = moved.displacement(x, 0, plan.input.end);
  bool supported = false;
  for (const Holder& holder : plan.holders) {
    const bool is_same = holder.is_boundary && holder.name == moved.name;
    if (is_same || std::find(holder.nodes.begin(), holder.nodes.end(), node) == holder.nodes.end()) continue;
    const fem::Point miss = way - holder.displacement(x, 0, plan.input.end);
    for (int axis = 0; axis < 2; ++axis) {
      if (!holder.axes[axis]) continue;
      supported = true;
      if (std::abs(miss[axis]) > 1e-9 * (1 + way.norm())) return false;
    }
  }
  return supported;
}

/// A boundary that changes its area is closed, or its ends stay on supports.
void check_area(const Scene& scene, const StagePlan& plan, const Holder& moved, const std::string& key) {
  const std::vector<fem::Edge>& chain = outer_edges(scene.mesh, moved.name);
  bool fits = !chain.empty();
  for (std::size_t k = 1; k < chain.size(); ++k) fits = fits && chain[k][0] == chain[k - 1][2];
  if (fits) {
    const std::array<int, 2> ends = ends_of(chain);
    fits = ends[0] == ends[1] ||
           std::all_of(ends.begin(), ends.end(), [&](int node) { return stays_on_supports(scene, plan, moved, node); });
  }
  if (!fits) refuse(key + ".area", moved.name + " is neither closed nor ends on supports through its point");
}

/// A stage moves a boundary or a point once along each axis: of two motions the first would be lost.
void check_moved_once(const StagePlan& plan, std::size_t first_move, std::size_t number, const std::string& key) {
  const Holder& moved = plan.holders[first_move + number];
  for (std::size_t k = 0; k < number; ++k) {
    const Holder& earlier = plan.holders[first_move + k];
    if (earlier.is_boundary != moved.is_boundary || earlier.nodes != moved.nodes) continue;
    for (int axis = 0; axis < 2; ++axis) {
      if (earlier.axes[axis] && moved.axes[axis])
        refuse(key, fmt::format("moves along {} what move[{}] of this stage moves already", axis_names[axis], k));
    }
  }
}

/// Nodes of the ground that is left, piece by piece.
std::vector<std::vector<int>> pieces_of(const fem::Mesh& mesh, const std::vector<char>& dug_out) {
  std::vector<int> parent(static_cast<std::size_t>(mesh.n_nodes()), -1);  // -1: of no element that is left
  const auto root = [&](int node) {
    while (parent[node] != node) node = parent[node] = parent[parent[node]];
    return node;
  };
  for (int e = 0; e < mesh.n_elements(); ++e) {
    if (!dug_out.empty() && dug_out[e] != 0) continue;
    for (const int node : mesh.elements[e]) {
      if (parent[node] < 0) parent[node] = node;
      parent[root(node)] = root(mesh.elements[e][0]);
    }
  }
  std::map<int, std::vector<int>> pieces;
  for (int node = 0; node < mesh.n_nodes(); ++node) {
    if (parent[node] >= 0) pieces[root(node)].push_back(node);
  }
  std::vector<std::vector<int>> list;
  for (auto& [first, nodes] : pieces) list.push_back(std::move(nodes));
  return list;
}

/// Rigid motions that the held degrees of freedom leave to a piece: along x, along y, rotation.
void check_held(const Scene& scene, const StagePlan& plan, const std::vector<int>& piece, bool is_all,
                const std::string& key) {
  fem::Point centre = fem::Point::Zero();
  for (const int node : piece) centre += scene.mesh.coordinates.col(node) / static_cast<double>(piece.size());
  double size = 0;
  for (const int node : piece) size = std::max(size, (fem::Point(scene.mesh.coordinates.col(node)) - centre).norm());
  Eigen::Matrix3d gram = Eigen::Matrix3d::Zero();
  for (const int node : piece) {
    const fem::Point arm = (fem::Point(scene.mesh.coordinates.col(node)) - centre) / size;
    if (plan.owners.contains(2 * node)) gram += Eigen::Vector3d(1, 0, -arm.y()) * Eigen::RowVector3d(1, 0, -arm.y());
    if (plan.owners.contains(2 * node + 1)) gram += Eigen::Vector3d(0, 1, arm.x()) * Eigen::RowVector3d(0, 1, arm.x());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> modes(gram);
  if (modes.eigenvalues()[0] > 1e-9) return;
  const Eigen::Vector3d free = modes.eigenvectors().col(0).cwiseAbs();
  Eigen::Index most = 0;
  free.maxCoeff(&most);
  const std::string what = is_all ? "the ground"
                                  : fmt::format("the piece of ground about ({:.4g}, {:.4g}) m", centre.x(), centre.y());
  refuse(key, most == 2 ? fmt::format("nothing keeps {} from turning", what)
                        : fmt::format("nothing holds {} along {}", what, axis_names[most]));
}

double shortest_edge_at(const fem::Mesh& mesh, const std::vector<int>& nodes) {
  const std::set<int> wanted(nodes.begin(), nodes.end());
  double shortest = std::numeric_limits<double>::infinity();
  for (const fem::ElementNodes& element : mesh.elements) {
    if (std::none_of(element.begin(), element.end(), [&](int node) { return wanted.contains(node); })) continue;
    shortest = std::min(shortest, shortest_edge(mesh, element));
  }
  return shortest;
}

}  // namespace

double shortest_edge(const fem::Mesh& mesh, const fem::ElementNodes& element) {
  double shortest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 4; ++k) {
    const fem::Point along = mesh.coordinates.col(element[(k + 1) % 4]) - mesh.coordinates.col(element[k]);
    shortest = std::min(shortest, along.norm());
  }
  return shortest;
}

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
    const std::vector<ReleaseCase>& releases = scene.input.stages[s].releases;
    for (std::size_t k = 0; k < releases.size(); ++k) {
      if (releases[k].boundary.empty())
        check_node(scene, fmt::format("stage[{}].release[{}].point", s, k), releases[k].point);
    }
    const std::vector<PressCase>& presses = scene.input.stages[s].presses;
    for (std::size_t k = 0; k < presses.size(); ++k) {
      if (outer_edges(scene.mesh, presses[k].boundary).empty())
        refuse(fmt::format("stage[{}].press[{}].boundary", s, k),
               presses[k].boundary + " lies inside the ground: it may be held or moved, but not pressed");
    }
  }
  check_excavations(scene);
}

void check_releases(const fem::Mesh& mesh, const StageCase& stage, const std::vector<Holder>& holders,
                    const std::map<Target, std::set<int>>& part_released, std::size_t number) {
  std::set<Target> known;
  for (std::size_t k = 0; k < stage.releases.size(); ++k) {
    const ReleaseCase& release = stage.releases[k];
    const std::string key = fmt::format("stage[{}].release[{}].{}", number, k,
                                        release.boundary.empty() ? "point" : "boundary");
    const Target target = target_of(mesh, release);
    const std::string name = name_of(mesh, release);
    if (!known.insert(target).second) refuse(key, fmt::format("names {} for the second time in this stage", name));
    const bool held = std::any_of(holders.begin(), holders.end(), [&](const Holder& holder) {
      return !holder.nodes.empty() && holder.target() == target;
    });
    const auto part = part_released.find(target);
    if (held || (part != part_released.end() && !part->second.empty())) continue;
    refuse(key, fmt::format("nothing holds {}{}", name, release.boundary.empty() ? " as a point" : ""));
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
    const std::string move_key = fmt::format("{}.move[{}]", key, k);
    if (moved.nodes.empty())
      refuse(move_key + (moved.is_boundary ? ".boundary" : ".point"),
             moved.is_boundary ? fmt::format("all of {} has been dug out", moved.name)
                               : "the ground about the point has been dug out");
    check_moved_once(plan, first_move, k, move_key);
    if (moved.move.area && moved.is_boundary) check_area(scene, plan, moved, move_key);
  }
  check_at_rest(plan, key);
  const std::vector<std::vector<int>> pieces = pieces_of(scene.mesh, plan.dug_out);
  const bool is_of_supports = number == 0 && plan.input.releases.empty() && plan.input.excavations.empty();
  for (const std::vector<int>& piece : pieces)
    check_held(scene, plan, piece, pieces.size() == 1, is_of_supports ? "support" : key);
}

void check_steps(const Scene& scene, const StagePlan& plan, std::size_t number) {
  for (const Holder& holder : plan.holders) {
    const double share = step_over_edge(scene, plan, holder);
    if (share > most_of_an_edge)
      refuse(fmt::format("stage[{}].steps", number),
             fmt::format("{} moves by {:.2g} of an element's edge a step: more steps", name_of(scene.mesh, holder),
                         share));
  }
}

}  // namespace voussoir::host
