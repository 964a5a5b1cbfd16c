#include "host/stages/tunnel.hpp"

#include <spdlog/fmt/fmt.h>

#include "fem/mesh_tunnel.hpp"
#include "host/case/engine.hpp"
#include "host/stages/make_material.hpp"

namespace voussoir::host {

fem::Mesh tunnel_mesh(const GroundCase& ground) {
  return fem::make_half_tunnel({.width = ground.width,
                                .height = ground.height,
                                .diameter = ground.diameter,
                                .cover = ground.cover(),
                                .size_near = ground.mesh_size_opening,
                                .size_far = ground.mesh_size_far});
}

namespace {

/// Column, gravity and volume loss, as far as they go; `column_totals` is what the column cost.
RunStatus run_stages(const Case& input, const RunOptions& options, const fem::Mesh& mesh, RunRecorder& recorder,
                     std::vector<StageTotals>& column_totals) {
  RunLog& log = recorder.log();
  RunOptions column_options = options;
  column_options.folder /= "column";
  Case column_input = input;
  column_input.output.rves.clear();  // they are points of the tunnel's mesh
  const ColumnResult column = run_column(column_input, column_options, log);
  column_totals = column.totals;
  if (column.status != RunStatus::finished) return column.status;

  recorder.set_table("k0", k0_columns(column.k0));

  const auto material = make_material(material_case(input), static_cast<std::size_t>(mesh.n_points()),
                                      [&log](const std::string& text) { log.detail(text); });
  Ground ground{input, mesh, *material, {}, {}};
  if (const io::Checkpoint* checkpoint = recorder.resumed()) {
    restore(ground, *checkpoint);
    log.line(
        fmt::format("resumed behind increment {} of {}", recorder.resumed_stage_index(), recorder.resumed_stage()));
  } else {
    begin_stage(ground);
  }
  const bool losing = recorder.resumed_stage() == "volume_loss";
  if (!losing) {
    const RunStatus gravity = settle_under_gravity(ground, column.k0, recorder, false);
    if (gravity != RunStatus::finished) return gravity;
  }
  return lose_volume(ground, column.k0, recorder, losing);
}

}  // namespace

RunStatus run_tunnel(const Case& input, const RunOptions& options) {
  const fem::Mesh mesh = tunnel_mesh(input.ground);
  std::filesystem::create_directories(options.folder);
  RunLog log(options.folder / "run.log", options.resume);
  RunRecorder recorder(options, input, "tunnel", mesh_data(mesh, input), log);
  if (recorder.finished()) {
    log.line(fmt::format("{}: finished already, nothing to do", options.folder.string()));
    return RunStatus::finished;
  }
  log.line(fmt::format("{}: {} elements, {} points of {}", input.name, mesh.n_elements(), mesh.n_points(),
                       to_string(input.material)));
  if (uses_engine(input.kind, input.material)) log.line(engine_note(input.engine));

  std::vector<StageTotals> totals;
  const RunStatus status = run_stages(input, options, mesh, recorder, totals);
  totals.insert(totals.end(), recorder.totals().begin(), recorder.totals().end());
  for (const std::string& line : totals_table(totals)) log.line(line);
  return status;
}

}  // namespace voussoir::host
