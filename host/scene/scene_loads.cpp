#include "host/scene/scene_loads.hpp"

#include <cmath>
#include <stdexcept>

#include "fem/assembly.hpp"

namespace voussoir::host {
namespace {

double between(double from, double to, double share) { return from == to ? from : from + share * (to - from); }

/// Adds a force of which each axis has its own share; equal shares of 1 add it as it is.
void add(Eigen::VectorXd& sum, const Eigen::VectorXd& force, const std::array<double, 2>& shares) {
  if (shares[0] == 1 && shares[1] == 1) {
    sum += force;
    return;
  }
  for (int axis = 0; axis < 2; ++axis) {
    if (shares[axis] == 0) continue;
    for (Eigen::Index dof = axis; dof < sum.size(); dof += 2) sum[dof] += shares[axis] * force[dof];
  }
}

}  // namespace

Eigen::VectorXd SceneLoads::weights(double share) const {
  if (cached_share_ == share || (cached_share_ >= 0 && !plan_.changes_gravity())) return cached_weights_;
  const double factor = between(plan_.gravity_from, plan_.gravity_to, share);
  const double tilt = between(plan_.tilt_from, plan_.tilt_to, share);
  std::vector<fem::Point> force(static_cast<std::size_t>(scene_.mesh.n_elements()));
  for (int e = 0; e < scene_.mesh.n_elements(); ++e) {
    const double weight = factor * scene_.unit_weight(e);
    force[e] = tilt == 0 ? fem::Point(0.0, -weight) : fem::Point(weight * std::sin(tilt), -weight * std::cos(tilt));
  }
  cached_weights_ = fem::body_force(scene_.mesh, scene_.mesh.coordinates, force);
  cached_share_ = share;
  return cached_weights_;
}

void SceneLoads::add_load(const BoundaryLoad& load, double share, Eigen::VectorXd& force) const {
  const fem::Coordinates& moved = ground_.state.coordinates;
  const fem::Coordinates& pressed = scene_.dead_pressure ? scene_.mesh.coordinates : moved;
  std::array<double, 2> pressure{}, traction{}, rest{};
  for (int axis = 0; axis < 2; ++axis) {
    pressure[axis] = between(load.pressure_from[axis], load.pressure_to[axis], share);
    traction[axis] = between(load.traction_from[axis], load.traction_to[axis], share);
    rest[axis] = between(load.rest_from[axis], load.rest_to[axis], share);
  }
  const double most = std::max(std::abs(pressure[0]), std::abs(pressure[1]));
  if (most > 0) {
    add(force, fem::pressure_force(pressed, load.edges, most), {pressure[0] / most, pressure[1] / most});
  }
  if (traction[0] != 0 || traction[1] != 0)
    force += fem::constant_traction_force(scene_.mesh.coordinates, load.edges, {traction[0], traction[1]});
  if (rest[0] != 0 || rest[1] != 0) {
    const double factor = between(plan_.gravity_from, plan_.gravity_to, share);
    add(force, rest_->force(moved, load.edges, factor), rest);
  }
}

Eigen::VectorXd SceneLoads::of_stage(double parameter) const {
  const double share = share_of(parameter);
  Eigen::VectorXd force = weights(share);
  for (const BoundaryLoad& load : plan_.loads) {
    if (!load.edges.empty()) add_load(load, share, force);
  }
  return force;
}

Eigen::VectorXd SceneLoads::internal_force() const {
  std::vector<fem::Stress> stress(static_cast<std::size_t>(scene_.mesh.n_points()));
  ground_.material.committed(stress, {});
  return fem::internal_force(scene_.mesh, fem::gauss_points(scene_.mesh, ground_.state.coordinates), stress).force;
}

void SceneLoads::drop_kept(Eigen::VectorXd& kept) const {
  for (const auto& [dof, owner] : plan_.owners) kept[dof] = 0;
  for (const auto& [dof, share] : plan_.fading) kept[dof] = 0;
  for (const int node : plan_.idle_nodes) kept.segment<2>(2 * node).setZero();
}

void SceneLoads::begin(const StagePlan* before, FadingForces& forces) const {
  if (before != nullptr && forces.fading.size() > 0) {
    if (forces.kept.size() == 0) forces.kept = Eigen::VectorXd::Zero(forces.fading.size());
    for (const auto& [dof, share] : before->fading) forces.kept[dof] += (1 - share) * forces.fading[dof];
    forces.fading.resize(0);
  }
  if (forces.kept.size() > 0) drop_kept(forces.kept);
  if (plan_.fading.empty()) return;
  Eigen::VectorXd missing = internal_force() - of_stage(0);
  if (forces.kept.size() > 0) missing -= forces.kept;
  forces.fading = Eigen::VectorXd::Zero(missing.size());
  for (const auto& [dof, share] : plan_.fading) forces.fading[dof] = missing[dof];
}

Eigen::VectorXd SceneLoads::all_forces(double parameter, const FadingForces& forces) const {
  Eigen::VectorXd force = of_stage(parameter);
  if (forces.kept.size() > 0) force += forces.kept;
  if (forces.fading.size() > 0) {
    for (const auto& [dof, share] : plan_.fading) force[dof] += (1 - share * share_of(parameter)) * forces.fading[dof];
  }
  return force;
}

fem::Constraints SceneLoads::increment(double from, double to) const {
  const fem::Coordinates& start = ground_.stage_coordinates();
  fem::Constraints constraints;
  for (const auto& [dof, owner] : plan_.owners) {
    const Holder& holder = plan_.holders[owner];
    const fem::Point centre = holder.about_node < 0 ? holder.about : fem::Point(start.col(holder.about_node));
    constraints[dof] = holder.displacement(start.col(dof / 2), from, to, centre)[dof % 2];
  }
  for (const int node : plan_.idle_nodes) constraints[2 * node] = constraints[2 * node + 1] = 0;
  return constraints;
}

fem::LoadPath SceneLoads::path(const FadingForces& forces) const {
  fem::LoadPath path;
  path.external_force = [this, &forces](double parameter) { return all_forces(parameter, forces); };
  path.prescribed_increment = [this](double from, double to) { return increment(from, to); };
  if (plan_.changes_gravity()) path.reference_force = path.external_force(plan_.input.end).norm();
  return path;
}

Eigen::VectorXd SceneLoads::reactions(double parameter, const FadingForces& forces) const {
  const Eigen::VectorXd unbalanced = internal_force() - all_forces(parameter, forces);
  Eigen::VectorXd reactions = Eigen::VectorXd::Zero(unbalanced.size());
  for (const auto& [dof, owner] : plan_.owners) reactions[dof] = unbalanced[dof];
  return reactions;
}

}  // namespace voussoir::host
