// Stage "volume_loss".
#include <spdlog/fmt/fmt.h>

#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "fem/assembly.hpp"
#include "fem/boundary.hpp"
#include "host/stages/stages.hpp"

namespace voussoir::host {
namespace {

double settlement(const Ground& ground, int node) { return 0.0 - ground.state.displacement[2 * node + 1]; }

/// Area lost by the opening over its original area [-].
double area_loss(const Ground& ground) {
  const std::vector<fem::Edge>& opening = ground.mesh.edge_set("opening");
  fem::Coordinates moved = ground.mesh.coordinates;
  for (Eigen::Index node = 0; node < moved.cols(); ++node) {
    moved.col(node) += ground.state.displacement.segment<2>(2 * node);
  }
  return 1.0 - fem::area_left_of(moved, opening) / fem::area_left_of(ground.mesh.coordinates, opening);
}

void add_tunnel_columns(const Ground& ground, io::IncrementInfo& info) {
  const std::vector<int>& top = ground.mesh.node_set("top");
  double largest = settlement(ground, top.front());
  for (const int node : top) largest = std::max(largest, settlement(ground, node));
  info.extra["crown_settlement"] = {settlement(ground, ground.mesh.node_set("crown").front()), "m"};
  info.extra["surface_settlement"] = {largest, "m"};
  info.extra["area_loss"] = {area_loss(ground), "-"};
}

void record_at_rest(const GeostaticCheck& at_rest, RunRecorder& recorder) {
  constexpr double degree = 180.0 / std::numbers::pi;
  recorder.log().line(
      fmt::format("after gravity: vertical stress within {:.3g} Pa of rest ({:.2f} of 5 % + 1 kPa), means of rows "
                  "{:.2f} of 2 % + 0.5 kPa, "
                  "their scatter up to {:.2g} %; K0 {:.3f} to {:.3f}; principal axis off by {:.2g} deg (mean), {:.2g} "
                  "deg (largest), {:.2g} "
                  "deg (largest from 100 kPa on)",
                  at_rest.vertical_error, at_rest.vertical_ratio, at_rest.row_ratio, 100 * at_rest.row_scatter,
                  at_rest.k0_minimum, at_rest.k0_maximum, at_rest.deflection_mean * degree,
                  at_rest.deflection_max * degree, at_rest.deflection_deep * degree));
  recorder.set_table("geostatic_check", {{"vertical_error", "Pa", {at_rest.vertical_error}},
                                         {"vertical_ratio", "-", {at_rest.vertical_ratio}},
                                         {"row_ratio", "-", {at_rest.row_ratio}},
                                         {"row_scatter", "-", {at_rest.row_scatter}},
                                         {"k0_minimum", "-", {at_rest.k0_minimum}},
                                         {"k0_maximum", "-", {at_rest.k0_maximum}},
                                         {"deflection_mean", "rad", {at_rest.deflection_mean}},
                                         {"deflection_max", "rad", {at_rest.deflection_max}},
                                         {"deflection_deep", "rad", {at_rest.deflection_deep}}});
  std::vector<io::TableColumn> rows{{"depth", "m", {}},  {"vertical_stress", "Pa", {}},
                                    {"error", "Pa", {}}, {"scatter", "Pa", {}},
                                    {"ratio", "-", {}},  {"deflection", "rad", {}}};
  for (const GeostaticRow& row : at_rest.rows) {
    const std::array<double, 6> values{row.depth, row.vertical, row.error, row.scatter, row.k0, row.deflection};
    for (std::size_t k = 0; k < rows.size(); ++k) rows[k].values.push_back(values[k]);
  }
  recorder.set_table("geostatic_rows", std::move(rows));
}

/// The state at V_l = 0, with the reactions of the opening that is now fixed, as the stage's increment 0.
void record_start(const Ground& ground, const K0Table& k0, RunRecorder& recorder) {
  record_at_rest(check_geostatic(ground), recorder);
  const OpeningCheck opening = check_opening(ground, k0);
  recorder.log().line(
      fmt::format("V_l = 0: reactions of the opening differ from its tractions by {:.2e} of them", opening.relative));
  recorder.set_table("opening_check",
                     {{"difference", "N/m", {opening.difference}}, {"relative", "-", {opening.relative}}});
  io::IncrementInfo info;
  info.stage = "volume_loss";
  info.converged = true;
  add_tunnel_columns(ground, info);
  record_ground(ground, info, opening.reactions, recorder);
}

/// Base, sides and axis as before; the opening follows the loss, its crown and invert stay on the axis of symmetry.
fem::Constraints volume_loss_constraints(const fem::Mesh& mesh, double from, double to) {
  fem::Constraints constraints = ground_supports(mesh);
  fem::constrain_volume_loss(constraints, mesh, from, to);
  return constraints;
}

}  // namespace

OpeningCheck check_opening(const Ground& ground, const K0Table& k0) {
  const fem::Mesh& mesh = ground.mesh;
  std::vector<fem::Stress> stress(static_cast<std::size_t>(mesh.n_points()));
  ground.material.committed(stress, {});
  const fem::GaussPoints points = fem::gauss_points(mesh, mesh.coordinates);
  const Eigen::VectorXd unbalanced = fem::internal_force(mesh, points, stress).force -
                                     ground_weight(mesh, ground.input.ground, 1.0);
  const Eigen::VectorXd tractions = opening_tractions(mesh, ground.input.ground, k0, 1.0);
  const fem::Constraints supports = ground_supports(mesh);

  OpeningCheck check;
  check.reactions = Eigen::VectorXd::Zero(mesh.n_dofs());
  for (const auto& [dof, value] : volume_loss_constraints(mesh, 0.0, 0.0)) check.reactions[dof] = unbalanced[dof];
  double difference = 0;
  double held = 0;
  for (const int node : mesh.node_set("opening")) {
    for (const int dof : {2 * node, 2 * node + 1}) {
      if (supports.contains(dof)) continue;  // crown and invert lean on the axis of symmetry as well
      difference += std::pow(unbalanced[dof] - tractions[dof], 2);
      held += std::pow(tractions[dof], 2);
    }
  }
  check.difference = std::sqrt(difference);
  check.relative = std::sqrt(difference / held);
  return check;
}

RunStatus lose_volume(Ground& ground, const K0Table& k0, RunRecorder& recorder, bool resumed) {
  if (!resumed) {
    begin_stage(ground);
    record_start(ground, k0, recorder);
  }
  const VolumeLossCase& loss = ground.input.volume_loss;
  const fem::Mesh& mesh = ground.mesh;
  const Eigen::VectorXd weight = ground_weight(mesh, ground.input.ground, 1.0);
  Stage stage;
  stage.name = "volume_loss";
  stage.kinematics = loss.geometry == LossGeometry::fixed_mesh ? fem::Kinematics::fixed_mesh
                                                               : fem::Kinematics::updated_lagrangian;
  stage.path.external_force = [&](double) { return weight; };
  stage.path.prescribed_increment = [&](double from, double to) { return volume_loss_constraints(mesh, from, to); };
  for (int k = 1; k <= loss.increments; ++k) stage.targets.push_back(loss.total * k / loss.increments);
  stage.last = true;
  stage.loses_volume = true;
  stage.on_record = [&](io::IncrementInfo& info) { add_tunnel_columns(ground, info); };
  return advance_stage(ground, stage, recorder);
}

}  // namespace voussoir::host
