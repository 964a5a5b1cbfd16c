#include "host/stages/tunnel.hpp"

#include <spdlog/fmt/fmt.h>

#include <filesystem>
#include <span>

#include "host/record/provenance.hpp"
#include "host/record/remarks.hpp"
#include "host/stages/column.hpp"
#include "host/stages/gravity.hpp"
#include "host/stages/ground_record.hpp"
#include "host/stages/ground_run.hpp"
#include "host/stages/tunnel_mesh.hpp"
#include "host/stages/volume_loss.hpp"

namespace voussoir::host {
namespace {

/// Runs the column of a tunnel, which is a run of its own in the folder `column`.
ColumnResult run_own_column(const Case& input, const RunOptions& options, RunLog& log) {
  RunOptions own = options;
  own.folder /= "column";
  // Not the folder of the run as well, which may have been moved since it was locked.
  std::filesystem::create_directory(own.folder);
  ColumnSetup setup = column_setup(input);
  setup.settings.output.rves.clear();  // these numbers are points of the tunnel's mesh
  return measure_k0(setup, own, provenance_of(own, input, "column"), log);
}

/// Runs gravity and, where it succeeds, the volume loss.
RunStatus run_stages(const Case& input, const K0Table& k0, GroundRun& run) {
  run.recorder().set_table("k0", k0_columns(k0));
  if (input.material == MaterialKind::grains) {
    const DrawScatter scatter = draw_scatter(input.packing.variety, input.packing.grains, input.volume_loss.total);
    run.recorder().set_table("draw_scatter", table_of(std::span(&scatter, 1), draw_scatter_columns));
  }
  // The lines about the packing go to the file only, since the column has written them to the terminal already.
  run.open_ground(material_case(input), [&run](const std::string& text) { run.log().detail(text); });
  const bool losing = run.recorder().resumed_stage() == "volume_loss";
  if (!losing) {
    const RunStatus gravity = settle_under_gravity(run, input.ground, input.gravity, k0);
    if (gravity != RunStatus::finished) return gravity;
  }
  return lose_volume(run, input.ground, input.volume_loss, k0, losing);
}

}  // namespace

RunStatus run_tunnel(const Case& input, const RunOptions& options) {
  const fem::Mesh mesh = tunnel_mesh(input.ground);
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

  const ColumnResult column = run_own_column(input, options, log);
  RunStatus status = column.status;
  if (status == RunStatus::finished) status = run_stages(input, column.k0, run);
  std::vector<StageTotals> totals = column.totals;
  totals.insert(totals.end(), run.recorder().totals().begin(), run.recorder().totals().end());
  for (const std::string& line : totals_table(totals)) log.line(line);
  return status;
}

}  // namespace voussoir::host
