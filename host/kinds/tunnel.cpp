#include "host/kinds/tunnel.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "host/kinds/geostatic_check.hpp"
#include "host/kinds/opening_check.hpp"
#include "host/kinds/tunnel_mesh.hpp"
#include "host/kinds/tunnel_scene.hpp"
#include "host/record/provenance.hpp"
#include "host/record/remarks.hpp"
#include "host/scene/boundary_columns.hpp"
#include "host/scene/k0_column.hpp"
#include "host/scene/run_stages.hpp"
#include "host/stages/confirm_mesh.hpp"
#include "host/stages/ground_record.hpp"
#include "host/stages/ground_run.hpp"

namespace voussoir::host {
namespace {

double settlement(const Ground& ground, int node) { return 0.0 - ground.state.displacement[2 * node + 1]; }

/// Gives the increments of the volume loss their columns.
void add_tunnel_columns(Stage& stage, const Ground& ground) {
  stage.on_record = [&ground](IncrementReport& increment) {
    increment.volume_loss = increment.info.load_parameter;
    add_columns(tunnel_report(ground), tunnel_columns, increment.info.extra);
  };
}

/// Compares the ground after gravity with the state at rest and records the state at V_l = 0, with the reactions of the
/// opening, which is fixed now.
void record_start(GroundRun& run, const GroundCase& soil, const StagePlan& gravity, const StagePlan& loss,
                  const GroundAtRest& rest, const Eigen::VectorXd& reactions) {
  const Ground& ground = run.ground();
  const GeostaticCheck at_rest = check_geostatic(ground, soil);
  run.log().line("after gravity: " + describe(at_rest));
  run.recorder().set_table("geostatic_check", table_of(std::span(&at_rest, 1), geostatic_columns));
  run.recorder().set_table("geostatic_rows", table_of(std::span(at_rest.rows), geostatic_row_columns));
  const Eigen::VectorXd tractions = rest.force(ground.mesh.coordinates, ground.mesh.edge_set("opening"), 1.0);
  const OpeningCheck opening = check_opening(ground.mesh, gravity, reactions, tractions);
  run.log().line(
      fmt::format("V_l = 0: the reactions of the opening differ from the tractions that held it by {:.2e} of these",
                  opening.relative));
  run.recorder().set_table("opening_check", table_of(std::span(&opening, 1), opening_columns));
  io::Quantities columns;
  add_columns(tunnel_report(ground), tunnel_columns, columns);
  record_stage_start(run, loss, reactions, columns);
}

/// Runs gravity and, where it succeeds, the volume loss.
RunStatus run_both_stages(const Case& input, const GroundAtRest& rest, Scene& scene, GroundRun& run) {
  run.recorder().set_table("k0", k0_columns(rest.k0.front()));
  if (input.material == MaterialKind::grains) {
    const DrawScatter scatter = draw_scatter(input.packing.variety, input.packing.grains, input.volume_loss.total);
    run.recorder().set_table("draw_scatter", table_of(std::span(&scatter, 1), draw_scatter_columns));
  }
  // The lines about the packing go to the file only, since the column has written them to the terminal already.
  run.open_ground(material_case(input), [&run](const std::string& text) { run.log().detail(text); });
  const std::vector<StagePlan> plans = plan_stages(scene);
  StageAdditions additions;
  additions.on_start = [&](const StagePlan& plan, const SceneLoads& loads, const FadingForces& forces) {
    if (plan.input.moves.empty()) return;
    record_start(run, input.ground, plans.front(), plan, rest, loads.reactions(0, forces));
  };
  additions.complete = [&](const StagePlan& plan, Stage& stage) {
    if (!plan.input.moves.empty()) add_tunnel_columns(stage, run.ground());
  };
  return run_stages(run, scene, plans, &rest, additions);
}

}  // namespace

TunnelReport tunnel_report(const Ground& ground) {
  const std::vector<int>& top = ground.mesh.node_set("top");
  TunnelReport report;
  report.crown_settlement = settlement(ground, ground.mesh.point("crown"));
  report.surface_settlement = settlement(ground, top.front());
  for (const int node : top) report.surface_settlement = std::max(report.surface_settlement, settlement(ground, node));
  report.area_loss = lost_area(ground, "opening");
  return report;
}

RunStatus run_tunnel(const Case& input, const RunOptions& options) {
  Scene scene = tunnel_scene(input, tunnel_mesh(input.ground));
  const fem::Mesh& mesh = scene.mesh;
  confirm_mesh(mesh_data(mesh, input.ground), options, "ground.mesh_file");
  RunLog log = open_log(options);
  tell_circumstances(options, log);
  GroundRun run(options, provenance_of(options, input, "tunnel"), mesh, mesh_data(mesh, input.ground),
                stage_settings(input), log);
  if (run.finished()) {
    run.report_finished();
    return RunStatus::finished;
  }
  log.line(fmt::format("{}: the mesh has {} elements and {} points of the material {}", input.name, mesh.n_elements(),
                       mesh.n_points(), to_string(input.material)));
  log_engine(input, log);
  say_remarks(input, log);
  if (input.material == MaterialKind::grains) log.line(draw_sentence(input.packing, input.volume_loss.total));

  const ColumnSetup setup = column_setup(input);
  const ColumnResult column = run_own_column(setup, input, options, log);
  RunStatus status = column.status;
  if (status == RunStatus::finished) {
    const GroundAtRest rest{.layers = setup.layers, .k0 = column.k0, .pressure = input.ground.surcharge};
    status = run_both_stages(input, rest, scene, run);
  }
  std::vector<StageTotals> totals = column.totals;
  totals.insert(totals.end(), run.recorder().totals().begin(), run.recorder().totals().end());
  for (const std::string& line : totals_table(totals)) log.line(line);
  return status;
}

}  // namespace voussoir::host
