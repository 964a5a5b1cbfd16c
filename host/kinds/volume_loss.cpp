#include "host/kinds/volume_loss.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <span>
#include <vector>

#include "host/kinds/geostatic_check.hpp"
#include "host/kinds/ground_loads.hpp"
#include "host/kinds/opening_check.hpp"
#include "host/stages/ground_record.hpp"
#include "host/stages/stage_driver.hpp"

namespace voussoir::host {
namespace {

double settlement(const Ground& ground, int node) { return 0.0 - ground.state.displacement[2 * node + 1]; }

/// The area that the opening has lost, over its original area [-].
double area_loss(const Ground& ground) {
  const std::vector<fem::Edge>& opening = ground.mesh.edge_set("opening");
  fem::Coordinates moved = ground.mesh.coordinates;
  for (Eigen::Index node = 0; node < moved.cols(); ++node) {
    moved.col(node) += ground.state.displacement.segment<2>(2 * node);
  }
  return 1.0 - fem::area_left_of(moved, opening) / fem::area_left_of(ground.mesh.coordinates, opening);
}

/// Records the state at V_l = 0 as increment 0 of the stage, with the reactions of the opening, which is fixed now.
void record_start(GroundRun& run, const GroundCase& soil, const K0Table& k0) {
  const Ground& ground = run.ground();
  const GeostaticCheck at_rest = check_geostatic(ground, soil);
  run.log().line("after gravity: " + describe(at_rest));
  run.recorder().set_table("geostatic_check", table_of(std::span(&at_rest, 1), geostatic_columns));
  run.recorder().set_table("geostatic_rows", table_of(std::span(at_rest.rows), geostatic_row_columns));
  const OpeningCheck opening = check_opening(ground, soil, k0);
  run.log().line(
      fmt::format("V_l = 0: the reactions of the opening differ from the tractions that held it by {:.2e} of "
                  "these",
                  opening.relative));
  run.recorder().set_table("opening_check", table_of(std::span(&opening, 1), opening_columns));
  IncrementReport start;
  start.info.stage = "volume_loss";
  start.info.converged = true;
  add_columns(tunnel_report(ground), tunnel_columns, start.info.extra);
  record_ground(ground, start, opening.reactions, run.settings().output, run.recorder());
  run.recorder().hand_over();
}

}  // namespace

TunnelReport tunnel_report(const Ground& ground) {
  const std::vector<int>& top = ground.mesh.node_set("top");
  TunnelReport report;
  report.crown_settlement = settlement(ground, ground.mesh.point("crown"));
  report.surface_settlement = settlement(ground, top.front());
  for (const int node : top) report.surface_settlement = std::max(report.surface_settlement, settlement(ground, node));
  report.area_loss = area_loss(ground);
  return report;
}

RunStatus lose_volume(GroundRun& run, const GroundCase& soil, const VolumeLossCase& loss, const K0Table& k0,
                      bool resumed) {
  Ground& ground = run.ground();
  if (!resumed) {
    begin_stage(ground);
    record_start(run, soil, k0);
  }
  const fem::Mesh& mesh = ground.mesh;
  const Eigen::VectorXd weight = ground_weight(mesh, soil, 1.0);
  Stage stage;
  stage.name = "volume_loss";
  stage.kinematics = loss.geometry == LossGeometry::fixed_mesh ? fem::Kinematics::fixed_mesh
                                                               : fem::Kinematics::updated_lagrangian;
  // NOLINTNEXTLINE(performance-no-automatic-move): each call gives a copy, so that there is nothing to move.
  stage.path.external_force = [&](double) { return weight; };
  stage.path.prescribed_increment = [&](double from, double to) { return volume_loss_constraints(mesh, from, to); };
  for (int k = 1; k <= loss.increments; ++k) stage.targets.push_back(loss.total * k / loss.increments);
  stage.last = true;
  stage.on_record = [&](IncrementReport& increment) {
    increment.volume_loss = increment.info.load_parameter;
    add_columns(tunnel_report(ground), tunnel_columns, increment.info.extra);
  };
  return advance_stage(run, stage);
}

}  // namespace voussoir::host
