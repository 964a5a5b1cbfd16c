#include "host/kinds/tunnel.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>
#include <stdexcept>

#include "host/kinds/column.hpp"
#include "host/kinds/gravity.hpp"
#include "host/kinds/tunnel_mesh.hpp"
#include "host/kinds/volume_loss.hpp"
#include "host/record/provenance.hpp"
#include "host/record/remarks.hpp"
#include "host/stages/ground_record.hpp"
#include "host/stages/ground_run.hpp"
#include "io/input_error.hpp"
#include "io/result_file.hpp"

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

/// A run goes on only on the mesh of its start; a stored mesh may be from another version of Gmsh.
/// @throws io::InputError
void confirm_mesh(const io::MeshData& mesh, const RunOptions& options, double height) {
  const std::filesystem::path index = options.folder / "run.h5";
  if (!options.resume || !std::filesystem::exists(index)) return;
  io::MeshData theirs;
  try {
    theirs = io::read_mesh(index);
  } catch (const std::runtime_error&) {
    return;  // the index is damaged; the run makes it anew
  }
  const auto close = [height](double a, double b) { return std::abs(a - b) <= 1e-9 * height; };
  const bool same = theirs.connectivity == mesh.connectivity &&
                    std::equal(theirs.coordinates.begin(), theirs.coordinates.end(), mesh.coordinates.begin(),
                               mesh.coordinates.end(), close);
  if (same) return;
  throw io::InputError("--resume", options.folder.string(),
                       fmt::format("was begun on another mesh, of {} elements and not {}: it needs the file of "
                                   "ground.mesh_file, or the version of Gmsh, that made its mesh",
                                   theirs.elements(), mesh.elements()));
}

}  // namespace

RunStatus run_tunnel(const Case& input, const RunOptions& options) {
  const fem::Mesh mesh = tunnel_mesh(input.ground);
  confirm_mesh(mesh_data(mesh, input.ground), options, input.ground.height);
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
