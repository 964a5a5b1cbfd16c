// Stage "column": a rectangle of the same RVEs under gravity. Every point follows the same oedometric path, so that all
// rows at all load factors are samples of one K0 (sigma_yy).
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>
#include <string>
#include <utility>

#include "fem/boundary.hpp"
#include "fem/mesh_rectangle.hpp"
#include "host/stages/make_material.hpp"
#include "host/stages/stages.hpp"
#include "io/atomic_file.hpp"

namespace voussoir::host {
namespace {

struct ColumnRow {
  K0Sample sample;
  double deflection = 0;  ///< of the principal axis from the vertical [rad], signed
};

/// Rows of Gauss points of a column one element wide: the points 0, 1 of an element are its lower row, 2, 3 its upper
/// one.
std::vector<ColumnRow> averaged_rows(const std::vector<fem::Stress>& stress) {
  std::vector<ColumnRow> rows;
  for (std::size_t p = 0; p + 1 < stress.size(); p += 2) {
    const fem::PlaneTensor mean = 0.5 * (stress[p] + stress[p + 1]);
    rows.push_back({{-mean[1], mean[0] / mean[1]}, fem::major_axis_from_vertical(mean)});
  }
  return rows;
}

std::vector<ColumnRow> rows_from(const io::Checkpoint& checkpoint) {
  const std::vector<double> flat = checkpoint.get_doubles("column_rows");
  std::vector<ColumnRow> rows;
  for (std::size_t k = 0; k + 2 < flat.size(); k += 3) rows.push_back({{flat[k], flat[k + 1]}, flat[k + 2]});
  return rows;
}

void put_rows(io::Checkpoint& checkpoint, const std::vector<ColumnRow>& rows) {
  std::vector<double> flat;
  for (const ColumnRow& row : rows) flat.insert(flat.end(), {row.sample.vertical, row.sample.ratio, row.deflection});
  checkpoint.put_doubles("column_rows", flat);
}

K0Table fit(const std::vector<ColumnRow>& rows, double initial_stress) {
  std::vector<K0Sample> samples;
  for (const ColumnRow& row : rows) samples.push_back(row.sample);
  return K0Table::fit(std::move(samples), initial_stress);
}

/// The rows of the last load factor as they were measured.
std::vector<io::TableColumn> rows_table(std::span<const ColumnRow> rows) {
  std::vector<io::TableColumn> columns{{"vertical_stress", "Pa", {}}, {"ratio", "-", {}}, {"deflection", "rad", {}}};
  for (const ColumnRow& row : rows) {
    columns[0].values.push_back(row.sample.vertical);
    columns[1].values.push_back(row.sample.ratio);
    columns[2].values.push_back(row.deflection);
  }
  return columns;
}

/// The fitted table as text, for a tunnel's user and for other programs.
void write_k0(const std::filesystem::path& folder, const K0Table& k0) {
  std::string fitted = "vertical_stress_Pa,k0\n";
  for (std::size_t k = 0; k < k0.stress().size(); ++k) {
    fitted += fmt::format("{:.9g},{:.9g}\n", k0.stress()[k], k0.ratio()[k]);
  }
  io::write_text(folder / "k0.csv", fitted);
}

Stage column_stage(const fem::Mesh& mesh, const Case& input, std::vector<ColumnRow>& rows) {
  Stage stage;
  stage.name = "column";
  stage.kinematics = fem::Kinematics::fixed_mesh;
  stage.path.external_force = [&](double lambda) { return ground_weight(mesh, input.ground, lambda); };
  stage.path.prescribed_increment = [supports = ground_supports(mesh)](double, double) { return supports; };
  stage.path.reference_force = stage.path.external_force(1.0).norm();
  stage.targets = gravity_targets(input);
  stage.last = true;
  stage.on_step = [&rows](const fem::ConvergedStep& step) {
    for (const ColumnRow& row : averaged_rows(step.increment.stress)) rows.push_back(row);
  };
  stage.on_record = [&rows, n = static_cast<std::size_t>(2 * mesh.n_elements())](io::IncrementInfo& info) {
    const auto now = std::span(rows).last(n);
    const auto deepest = std::max_element(now.begin(), now.end(), [](const ColumnRow& a, const ColumnRow& b) {
      return a.sample.vertical < b.sample.vertical;
    });
    info.extra["k0_at_base"] = {deepest->sample.ratio, "-"};
    info.extra["deflection_at_base"] = {deepest->deflection, "rad"};
  };
  stage.on_checkpoint = [&rows](io::Checkpoint& checkpoint) { put_rows(checkpoint, rows); };
  return stage;
}

}  // namespace

std::vector<io::TableColumn> k0_columns(const K0Table& k0) {
  return {{"vertical_stress", "Pa", k0.stress()}, {"ratio", "-", k0.ratio()}};
}

ColumnResult run_column(const Case& input, const RunOptions& options, RunLog& log) {
  const fem::Mesh mesh = fem::make_rectangle(input.column.width, input.ground.height, 1, input.column.elements);
  RunRecorder recorder(options, input, "column", mesh_data(mesh, input), log);
  std::vector<ColumnRow> rows;
  if (const io::Checkpoint* checkpoint = recorder.resumed()) rows = rows_from(*checkpoint);
  if (!recorder.finished()) {
    const auto material = make_material(material_case(input), static_cast<std::size_t>(mesh.n_points()),
                                        [&log](const std::string& text) { log.line(text); });
    Ground ground{input, mesh, *material, {}, {}};
    if (const io::Checkpoint* checkpoint = recorder.resumed()) {
      restore(ground, *checkpoint);
    } else {
      begin_stage(ground);
    }
    const RunStatus status = advance_stage(ground, column_stage(mesh, input, rows), recorder);
    if (status != RunStatus::finished) return {status, {}, recorder.totals()};
  }
  const K0Table k0 = fit(rows, input.ground.surcharge);
  if (!recorder.finished() || !std::filesystem::exists(options.folder / "k0.csv")) write_k0(options.folder, k0);
  const std::size_t last_rows = std::min(rows.size(), static_cast<std::size_t>(2 * mesh.n_elements()));
  recorder.set_table("k0", k0_columns(k0));
  recorder.set_table("column_rows", rows_table(std::span(rows).last(last_rows)));
  log.line(fmt::format("column: K0 falls from 1 at {:.3g} Pa to {:.3f} at {:.3g} Pa", input.ground.surcharge,
                       k0.ratio().back(), k0.stress().back()));
  return {RunStatus::finished, k0, recorder.totals()};
}

}  // namespace voussoir::host
