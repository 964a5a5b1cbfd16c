#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "fem/load_stepper.hpp"
#include "host/scene/scene.hpp"
#include "host/scene/scene_checks.hpp"

namespace voussoir::host {
namespace {

/// What holds and loads the scene between two stages.
struct Standing {
  std::vector<Holder> holders;
  std::vector<BoundaryLoad> loads;  ///< `..._to` counts
  double gravity = 0, tilt = 0;
  std::vector<char> dug_out;
  std::map<Target, std::set<int>> part_released;
};

std::vector<Holder> holders_of(const Scene& scene, const SupportCase& support) {
  const std::array<bool, 2> axes{support.x, support.y};
  std::vector<Holder> holders;
  for (const std::string& name : support.boundaries) {
    holders.push_back({.name = name, .nodes = scene.mesh.node_set(name), .axes = axes});
  }
  if (support.boundaries.empty()) {
    holders.push_back({.name = support.point.name,
                       .is_boundary = false,
                       .nodes = {node_at(scene.mesh, support.point)},
                       .axes = axes});
  }
  return holders;
}

Holder holder_of(const Scene& scene, const MoveCase& move) {
  Holder holder{.name = move.boundary, .is_boundary = !move.boundary.empty(), .move = move};
  if (holder.is_boundary) {
    holder.nodes = scene.mesh.node_set(move.boundary);
  } else {
    holder.name = move.point.name;
    holder.nodes = {node_at(scene.mesh, move.point)};
  }
  holder.axes = {move.is_affine() || move.x.has_value(), move.is_affine() || move.y.has_value()};
  if (move.is_affine()) {
    holder.about = coordinates_of(scene.mesh, move.about);
    if (!move.about.name.empty()) holder.about_node = node_at(scene.mesh, move.about);
  }
  return holder;
}

Standing first_standing(const Scene& scene) {
  Standing standing;
  for (const SupportCase& support : scene.input.supports) {
    for (Holder& holder : holders_of(scene, support)) standing.holders.push_back(std::move(holder));
  }
  const auto loaded = [&](const std::string& name, const std::vector<fem::Edge>& edges) {
    BoundaryLoad load{.boundary = name, .edges = edges};
    load.pressure_to = {scene.pressure, scene.pressure};
    standing.loads.push_back(std::move(load));
  };
  for (const auto& [name, edges] : scene.mesh.edges) loaded(name, edges);
  loaded("", scene.mesh.unnamed_edges);
  return standing;
}

std::map<int, std::size_t> owners_of(const std::vector<Holder>& holders) {
  std::map<int, std::size_t> owners;
  for (std::size_t k = 0; k < holders.size(); ++k) {
    for (const int node : holders[k].nodes) {
      for (int axis = 0; axis < 2; ++axis) {
        if (holders[k].axes[axis]) owners[2 * node + axis] = k;
      }
    }
  }
  return owners;
}

/// Whether a holder of this very boundary holds it along an axis.
bool is_held(const std::vector<Holder>& holders, const std::string& boundary, int axis) {
  return std::any_of(holders.begin(), holders.end(), [&](const Holder& holder) {
    return holder.is_boundary && holder.name == boundary && holder.axes[axis];
  });
}

/// Starts a stage on what stands: what was moved stays, and what was loaded stays loaded.
StagePlan plan_on(const Standing& standing, const StageCase& input) {
  StagePlan plan{.input = input, .holders = standing.holders, .loads = standing.loads};
  for (Holder& holder : plan.holders) {
    MoveCase stays;
    stays.boundary = holder.move.boundary;
    stays.point = holder.move.point;
    holder.move = stays;
  }
  for (BoundaryLoad& load : plan.loads) {
    load.pressure_from = load.pressure_to;
    load.traction_from = load.traction_to;
    load.rest_from = load.rest_to;
  }
  plan.gravity_from = standing.gravity;
  plan.tilt_from = standing.tilt;
  plan.gravity_to = input.gravity.value_or(standing.gravity);
  plan.tilt_to = input.tilt.value_or(standing.tilt);
  plan.dug_out = standing.dug_out;
  plan.part_released = standing.part_released;
  return plan;
}

/// The same load as StagePlan::load_of, to be changed.
BoundaryLoad* load_of(StagePlan& plan, const std::string& boundary) {
  const BoundaryLoad* load = plan.load_of(boundary);
  return load == nullptr ? nullptr : &plan.loads[static_cast<std::size_t>(load - plan.loads.data())];
}

void clear(BoundaryLoad& load, int axis) {
  for (auto* values : {&load.pressure_from, &load.pressure_to, &load.traction_from, &load.traction_to, &load.rest_from,
                       &load.rest_to}) {
    (*values)[axis] = 0;
  }
}

/// Takes away all holders of the targets at once, so that the order of the releases does not matter: a degree of
/// freedom that nothing holds any more is released with the target that has owned it.
void let_go(StagePlan& plan, const std::set<Target>& targets) {
  const std::vector<Holder> holders = plan.holders;
  const std::map<int, std::size_t> before = owners_of(holders);
  std::erase_if(plan.holders, [&](const Holder& holder) { return targets.contains(holder.target()); });
  const std::map<int, std::size_t> after = owners_of(plan.holders);
  for (const Holder& holder : holders) {
    const Target target = holder.target();
    if (!targets.contains(target)) continue;
    for (const int node : holder.nodes) {
      for (int axis = 0; axis < 2; ++axis) {
        const int dof = 2 * node + axis;
        if (!holder.axes[axis]) continue;
        const bool is_own = !after.contains(dof) && holders[before.at(dof)].target() == target;
        (is_own ? plan.released[target].own : plan.released[target].others).insert(dof);
      }
    }
  }
}

/// The own load of a boundary begins at nothing along the axes along which it is free now.
void clear_loads(StagePlan& plan, const std::string& boundary, const std::array<bool, 2>& freed) {
  BoundaryLoad* load = load_of(plan, boundary);
  if (load == nullptr) return;
  for (int axis = 0; axis < 2; ++axis) {
    if (freed[axis]) clear(*load, axis);
  }
}

/// The forces that held boundaries and points fade. Of what was released in part before, the rest of the forces fades.
void release(const fem::Mesh& mesh, StagePlan& plan) {
  std::set<Target> targets;
  for (const ReleaseCase& one : plan.input.releases) {
    targets.insert(target_of(mesh, one));
    if (one.boundary.empty()) continue;  // a point has no load of its own
    clear_loads(plan, one.boundary, {is_held(plan.holders, one.boundary, 0), is_held(plan.holders, one.boundary, 1)});
  }
  let_go(plan, targets);
  for (const ReleaseCase& one : plan.input.releases) {
    const Target target = target_of(mesh, one);
    std::set<int>& own = plan.released[target].own;
    own.merge(plan.part_released[target]);
    for (const int dof : own) plan.fading[dof] = one.share;
    plan.part_released.erase(target);
    if (one.share < 1) plan.part_released[target] = own;
  }
}

/// What a release of an earlier stage has left of the forces on the boundary fades, because it loads the boundary until
/// now.
void replace_rest_of_release(StagePlan& plan, const std::string& boundary) {
  for (const ReleaseCase& one : plan.input.releases) {
    if (one.boundary == boundary) return;
  }
  const Target target{.boundary = boundary};
  for (const int dof : plan.part_released[target]) plan.fading[dof] = 1.0;
  plan.part_released.erase(target);
}

/// @param no_weights the ground has no weight until now, so that ground at rest presses with its own pressure
void press(StagePlan& plan, const PressCase& press, double own_pressure, bool no_weights) {
  replace_rest_of_release(plan, press.boundary);
  BoundaryLoad& load = *load_of(plan, press.boundary);  // check_places: it has outer edges
  for (int axis = 0; axis < 2; ++axis) {
    load.pressure_to[axis] = press.kind == PressKind::pressure ? press.pressure : 0.0;
    load.traction_to[axis] = press.kind == PressKind::traction ? press.traction[axis] : 0.0;
    load.rest_to[axis] = press.kind == PressKind::at_rest ? 1.0 : 0.0;
    const bool is_at_rest = no_weights && load.pressure_from[axis] == own_pressure && load.traction_from[axis] == 0 &&
                            load.rest_from[axis] == 0;
    if (press.kind == PressKind::at_rest && is_at_rest) {
      load.pressure_from[axis] = 0;
      load.rest_from[axis] = 1;
    }
  }
}

void excavate(const Scene& scene, StagePlan& plan, const ExcavateCase& excavation) {
  const fem::Mesh& mesh = scene.mesh;
  plan.dug_out.resize(static_cast<std::size_t>(mesh.n_elements()), 0);
  for (int e = 0; e < mesh.n_elements(); ++e) {
    if (mesh.in_region(e, excavation.regions)) plan.dug_out[e] = 1;
  }
}

std::vector<char> nodes_in_use(const fem::Mesh& mesh, const std::vector<char>& dug_out) {
  std::vector<char> used(static_cast<std::size_t>(mesh.n_nodes()), 0);
  for (int e = 0; e < mesh.n_elements(); ++e) {
    if (!dug_out.empty() && dug_out[e] != 0) continue;
    for (const int node : mesh.elements[e]) used[node] = 1;
  }
  return used;
}

/// Takes what has been dug out from loads and holders, and lets the forces on its edge fade.
void leave_out_dug(const Scene& scene, StagePlan& plan, const std::vector<char>& dug_before) {
  if (plan.dug_out.empty()) return;
  const fem::Mesh& mesh = scene.mesh;
  const std::vector<char> used = nodes_in_use(mesh, plan.dug_out);
  for (int node = 0; node < mesh.n_nodes(); ++node) {
    if (used[node] == 0) plan.idle_nodes.push_back(node);
  }
  for (Holder& holder : plan.holders) std::erase_if(holder.nodes, [&](int node) { return used[node] == 0; });
  const auto is_idle = [&](int dof) { return used[dof / 2] == 0; };
  for (auto& [target, dofs] : plan.part_released) std::erase_if(dofs, is_idle);
  for (auto& [target, released] : plan.released) {
    std::erase_if(released.own, is_idle);
    std::erase_if(released.others, is_idle);
  }
  std::set<int> mids;  // of edges that are left; an outer edge belongs to one element
  for (int e = 0; e < mesh.n_elements(); ++e) {
    if (plan.dug_out[e] == 0) mids.insert(mesh.elements[e].begin() + 4, mesh.elements[e].end());
  }
  for (BoundaryLoad& load : plan.loads) {
    std::erase_if(load.edges, [&](const fem::Edge& edge) { return !mids.contains(edge[1]); });
  }
  const std::map<int, std::size_t> owners = owners_of(plan.holders);
  for (int e = 0; e < mesh.n_elements(); ++e) {
    if (plan.dug_out[e] == 0 || (!dug_before.empty() && dug_before[e] != 0)) continue;
    for (const int node : mesh.elements[e]) {
      for (int dof = 2 * node; used[node] != 0 && dof < 2 * node + 2; ++dof) {
        if (!owners.contains(dof)) plan.fading[dof] = 1.0;
      }
    }
  }
}

}  // namespace

std::vector<double> gravity_targets(const GravityCase& gravity, double carried, double rise) {
  return fem::geometric_targets(carried / rise, gravity.ratio, gravity.uniform_step);
}

double weight_stress(const Scene& scene) {
  const Eigen::RowVectorXd y = scene.mesh.coordinates.row(1);
  double heaviest = 0;
  for (const RegionCase& region : scene.input.regions) heaviest = std::max(heaviest, region.unit_weight);
  return heaviest * (y.maxCoeff() - y.minCoeff());
}

namespace {

std::vector<double> targets_of(const Scene& scene, const StagePlan& plan) {
  std::vector<double> targets;
  const double rise = plan.gravity_to - plan.gravity_from;
  const double full = weight_stress(scene);
  if (plan.input.steps == 0 && rise > 0 && full > 0)
    return gravity_targets(scene.gravity, scene.pressure / full + plan.gravity_from, rise);
  const int n = plan.input.steps > 0 ? plan.input.steps : static_cast<int>(std::ceil(1 / scene.gravity.uniform_step));
  for (int k = 1; k <= n; ++k) targets.push_back(plan.input.end * k / n);
  return targets;
}

Standing standing_after(const StagePlan& plan) {
  return {.holders = plan.holders,
          .loads = plan.loads,
          .gravity = plan.gravity_to,
          .tilt = plan.tilt_to,
          .dug_out = plan.dug_out,
          .part_released = plan.part_released};
}

/// What holds a boundary along an axis carries its load there. A load that faces no other axis is none any more; its
/// rounding along the boundary would be a load otherwise.
void leave_to_holders(BoundaryLoad& load, const fem::Mesh& mesh, const std::vector<Holder>& holders) {
  const std::array<bool, 2> held{is_held(holders, load.boundary, 0), is_held(holders, load.boundary, 1)};
  if (!held[0] && !held[1]) return;
  for (int axis = 0; axis < 2; ++axis) {
    const bool loaded = !held[axis] && (faces(mesh, load.edges, axis) || load.traction_to[axis] != 0);
    if (!loaded) clear(load, axis);
  }
}

StagePlan plan_stage(const Scene& scene, const Standing& standing, const StageCase& input) {
  StagePlan plan = plan_on(standing, input);
  release(scene.mesh, plan);
  for (const ExcavateCase& one : input.excavations) excavate(scene, plan, one);
  for (const MoveCase& move : input.moves) plan.holders.push_back(holder_of(scene, move));
  for (const PressCase& one : input.presses) press(plan, one, scene.pressure, standing.gravity == 0);
  leave_out_dug(scene, plan, standing.dug_out);
  plan.owners = owners_of(plan.holders);
  std::erase_if(plan.fading, [&](const auto& entry) { return plan.owners.contains(entry.first); });
  for (auto& [target, dofs] : plan.part_released)
    std::erase_if(dofs, [&](int dof) { return plan.owners.contains(dof); });
  for (BoundaryLoad& load : plan.loads) leave_to_holders(load, scene.mesh, plan.holders);
  plan.targets = targets_of(scene, plan);
  return plan;
}

}  // namespace

std::vector<StagePlan> plan_stages(const Scene& scene) {
  check_places(scene);
  std::vector<StagePlan> plans;
  Standing standing = first_standing(scene);
  for (const StageCase& stage : scene.input.stages) {
    check_releases(scene.mesh, stage, standing.holders, standing.part_released, plans.size());
    StagePlan plan = plan_stage(scene, standing, stage);
    check_stage(scene, plan, plans.size());
    standing = standing_after(plan);
    plans.push_back(std::move(plan));
  }
  return plans;
}

}  // namespace voussoir::host
