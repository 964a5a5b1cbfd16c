#include "host/kinds/column.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>
#include <string>

#include "fem/mesh_rectangle.hpp"
#include "host/kinds/ground_loads.hpp"
#include "host/record/provenance.hpp"
#include "host/record/remarks.hpp"
#include "host/stages/ground_record.hpp"
#include "host/stages/stage_driver.hpp"
#include "io/atomic_file.hpp"

namespace voussoir::host {
namespace {

/// Rows of Gauss points of a column one element wide. The points 0 and 1 of an element are its lower row, the points 2
/// and 3 its upper one.
std::vector<ColumnRow> averaged_rows(const std::vector<fem::Stress>& stress) {
  std::vector<ColumnRow> rows;
  for (std::size_t p = 0; p + 1 < stress.size(); p += 2) {
    const fem::PlaneTensor mean = 0.5 * (stress[p] + stress[p + 1]);
    rows.push_back({-mean[1], mean[0] / mean[1], fem::major_axis_from_vertical(mean)});
  }
  return rows;
}

std::vector<ColumnRow> rows_from(const io::Checkpoint& checkpoint) {
  const std::vector<double> flat = checkpoint.get_doubles("column_rows");
  std::vector<ColumnRow> rows;
  for (std::size_t k = 0; k + 2 < flat.size(); k += 3) rows.push_back({flat[k], flat[k + 1], flat[k + 2]});
  return rows;
}

void put_rows(io::Checkpoint& checkpoint, const std::vector<ColumnRow>& rows) {
  std::vector<double> flat;
  for (const ColumnRow& row : rows) flat.insert(flat.end(), {row.vertical, row.ratio, row.deflection});
  checkpoint.put_doubles("column_rows", flat);
}

K0Table fit(const std::vector<ColumnRow>& rows, double initial_stress) {
  std::vector<K0Sample> samples;
  for (const ColumnRow& row : rows) samples.push_back({row.vertical, row.ratio});
  return K0Table::fit(std::move(samples), initial_stress);
}

/// Writes the fitted table as text, for the user of a tunnel and for other programs.
void write_k0(const std::filesystem::path& folder, const K0Table& k0) {
  std::string fitted = "vertical_stress_Pa,k0\n";
  for (std::size_t k = 0; k < k0.stress().size(); ++k) {
    fitted += fmt::format("{:.9g},{:.9g}\n", k0.stress()[k], k0.ratio()[k]);
  }
  io::write_text(folder / "k0.csv", fitted);
}

/// The stage of the column. `mesh`, `setup` and `rows` must outlive the stage.
Stage column_stage(const fem::Mesh& mesh, const ColumnSetup& setup, std::vector<ColumnRow>& rows) {
  Stage stage;
  stage.name = "column";
  stage.kinematics = fem::Kinematics::fixed_mesh;
  stage.path.external_force = [&](double lambda) { return ground_weight(mesh, setup.soil, lambda); };
  stage.path.prescribed_increment = [supports = ground_supports(mesh)](double, double) { return supports; };
  stage.path.reference_force = stage.path.external_force(1.0).norm();
  stage.targets = gravity_targets(setup.soil, setup.gravity);
  stage.last = true;
  stage.on_step = [&rows](const fem::ConvergedStep& step) {
    for (const ColumnRow& row : averaged_rows(step.increment.stress)) rows.push_back(row);
  };
  stage.on_record = [&rows, n = 2 * static_cast<std::size_t>(mesh.n_elements())](IncrementReport& increment) {
    const auto now = std::span(rows).last(n);
    const auto deepest = std::max_element(
        now.begin(), now.end(), [](const ColumnRow& a, const ColumnRow& b) { return a.vertical < b.vertical; });
    add_columns(*deepest, column_base_columns, increment.info.extra);
  };
  stage.on_checkpoint = [&rows](io::Checkpoint& checkpoint) { put_rows(checkpoint, rows); };
  return stage;
}

}  // namespace

ColumnSetup column_setup(const Case& input) {
  return {.column = input.column,
          .soil = input.ground,
          .gravity = input.gravity,
          .material = material_case(input),
          .settings = stage_settings(input)};
}

std::vector<io::TableColumn> k0_columns(const K0Table& k0) {
  return {{"vertical_stress", "Pa", k0.stress()}, {"ratio", "-", k0.ratio()}};
}

ColumnResult measure_k0(const ColumnSetup& setup, const RunOptions& options, const io::Provenance& provenance,
                        RunLog& log) {
  const fem::Mesh mesh = fem::make_rectangle(setup.column.width, setup.soil.height, 1, setup.column.elements);
  GroundRun run(options, provenance, mesh, mesh_data(mesh, setup.soil), setup.settings, log);
  RunRecorder& recorder = run.recorder();
  std::vector<ColumnRow> rows;
  if (const io::Checkpoint* checkpoint = recorder.resumed()) rows = rows_from(*checkpoint);
  if (!run.finished()) {
    run.open_ground(setup.material, [&log](const std::string& text) { log.line(text); });
    const RunStatus status = advance_stage(run, column_stage(mesh, setup, rows));
    if (status != RunStatus::finished) return {status, {}, recorder.totals()};
  }
  const K0Table k0 = fit(rows, setup.soil.surcharge);
  if (!run.finished() || !std::filesystem::exists(options.folder / "k0.csv")) write_k0(options.folder, k0);
  const std::size_t last_rows = std::min(rows.size(), 2 * static_cast<std::size_t>(mesh.n_elements()));
  recorder.set_table("k0", k0_columns(k0));
  recorder.set_table("column_rows", table_of(std::span(rows).last(last_rows), column_row_columns));
  log.line(fmt::format("column: K0 falls from 1 at {:.3g} Pa to {:.3f} at {:.3g} Pa", setup.soil.surcharge,
                       k0.ratio().back(), k0.stress().back()));
  return {RunStatus::finished, k0, recorder.totals()};
}

RunStatus run_column(const Case& input, const RunOptions& options) {
  RunLog log = open_log(options);
  tell_circumstances(options, log);
  log_engine(input, log);
  say_remarks(input, log);
  const ColumnResult column = measure_k0(column_setup(input), options, provenance_of(options, input, "column"), log);
  for (const std::string& line : totals_table(column.totals)) log.line(line);
  return column.status;
}

}  // namespace voussoir::host
