#include "host/scene/k0_column.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>
#include <string>
#include <utility>

#include "fem/mesh_rectangle.hpp"
#include "host/record/provenance.hpp"
#include "host/scene/run_stages.hpp"
#include "host/scene/scene_mesh.hpp"
#include "host/stages/ground_record.hpp"
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

/// The layer of an element: the regions of the mesh go upwards, the layers downwards.
std::size_t layer_of(const fem::Mesh& mesh, std::size_t element) {
  if (mesh.region.empty()) return 0;
  return mesh.region_names.size() - 1 - static_cast<std::size_t>(mesh.region[element]);
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

/// Fits the K0 of one layer to the rows of its elements.
K0Table fit(const std::vector<ColumnRow>& rows, const fem::Mesh& mesh, std::size_t layer, double initial_stress) {
  std::vector<K0Sample> samples;
  const std::size_t n = 2 * static_cast<std::size_t>(mesh.n_elements());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (layer_of(mesh, k % n / 2) == layer) samples.push_back({rows[k].vertical, rows[k].ratio});
  }
  return K0Table::fit(std::move(samples), initial_stress);
}

/// Writes the fitted table as text, for the user of a tunnel and for other programs.
void write_k0(const std::filesystem::path& file, const K0Table& k0) {
  std::string fitted = "vertical_stress_Pa,k0\n";
  for (std::size_t k = 0; k < k0.stress().size(); ++k) {
    fitted += fmt::format("{:.9g},{:.9g}\n", k0.stress()[k], k0.ratio()[k]);
  }
  io::write_text(file, fitted);
}

/// The elements of each layer: all of them shared out by the layers' thickness, at least one each.
std::vector<std::int64_t> rows_of(const ColumnSetup& setup) {
  const double height = setup.layers.front().top - setup.layers.back().bottom;
  std::vector<std::int64_t> rows;
  for (const GroundLayer& layer : setup.layers) {
    const double share = (layer.top - layer.bottom) / height;
    rows.push_back(std::max<std::int64_t>(1, std::llround(share * setup.column.elements)));
  }
  return rows;
}

/// A single row of elements from y = 0 up; its regions are the layers.
fem::Mesh column_mesh(const ColumnSetup& setup) {
  const double base = setup.layers.back().bottom;
  if (setup.layers.size() == 1)
    return fem::make_rectangle(setup.column.width, setup.layers.front().top - base, 1, setup.column.elements);
  SceneMeshCase grid;
  grid.shape = MeshShape::grid;
  grid.x = {0, setup.column.width};
  grid.columns = {1};
  grid.y = {0};
  grid.layers.clear();
  grid.rows = rows_of(setup);
  std::reverse(grid.rows.begin(), grid.rows.end());
  for (std::size_t k = setup.layers.size(); k-- > 0;) {
    grid.y.push_back(setup.layers[k].top - base);
    grid.layers.push_back(setup.layers[k].region);
  }
  grid.x_ratio = {1};
  grid.y_ratio.assign(grid.rows.size(), 1);
  grid.left = {"axis"};
  grid.right = {"side"};
  return scene_mesh(grid);
}

Scene column_scene(const ColumnSetup& setup) {
  Scene scene{.input = {}, .mesh = column_mesh(setup), .pressure = setup.surcharge, .gravity = setup.gravity};
  for (const GroundLayer& layer : setup.layers) {
    RegionCase region;
    region.names = {layer.region};
    region.unit_weight = layer.unit_weight;
    scene.input.regions.push_back(std::move(region));
  }
  scene.input.supports = {{.boundaries = {"base"}, .point = {}, .x = true, .y = true},
                          {.boundaries = {"side", "axis"}, .point = {}, .x = true}};
  StageCase stage;
  stage.name = "column";
  stage.gravity = 1.0;
  stage.geometry = LossGeometry::fixed_mesh;
  scene.input.stages = {stage};
  return scene;
}

io::MeshData column_data(const fem::Mesh& mesh, const ColumnSetup& setup) {
  io::MeshData data = mesh_data(mesh);
  data.geometry = {{"surface_y", setup.layers.front().top - setup.layers.back().bottom},
                   {"surcharge", setup.surcharge}};
  if (setup.layers.size() == 1) data.geometry["unit_weight"] = setup.layers.front().unit_weight;
  return data;
}

/// Gives the stage of the column its rows. `rows` must outlive the stage.
void add_rows(Stage& stage, const fem::Mesh& mesh, std::vector<ColumnRow>& rows) {
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
}

/// Fits and writes the tables of a finished column.
std::vector<K0Table> write_tables(const ColumnSetup& setup, const fem::Mesh& mesh, const std::vector<ColumnRow>& rows,
                                  GroundRun& run) {
  RunRecorder& recorder = run.recorder();
  std::vector<K0Table> tables;
  for (std::size_t layer = 0; layer < setup.layers.size(); ++layer) {
    const K0Table k0 = fit(rows, mesh, layer, setup.surcharge);
    const std::string name = k0_name(setup.layers, layer);
    const std::filesystem::path file = recorder.folder() / (name + ".csv");
    if (!run.finished() || !std::filesystem::exists(file)) write_k0(file, k0);
    recorder.set_table(name, k0_columns(k0));
    run.log().line(fmt::format("column{}: K0 falls from 1 at {:.3g} Pa to {:.3f} at {:.3g} Pa",
                               setup.layers.size() > 1 ? " of " + setup.layers[layer].region : "", setup.surcharge,
                               k0.ratio().back(), k0.stress().back()));
    tables.push_back(k0);
  }
  const std::size_t last_rows = std::min(rows.size(), 2 * static_cast<std::size_t>(mesh.n_elements()));
  recorder.set_table("column_rows", table_of(std::span(rows).last(last_rows), column_row_columns));
  return tables;
}

}  // namespace

ColumnSetup column_setup(const Case& input) {
  return {.column = input.column,
          .layers = {{.region = "", .bottom = 0, .top = input.ground.height, .unit_weight = input.ground.unit_weight}},
          .surcharge = input.ground.surcharge,
          .gravity = input.gravity,
          .material = material_case(input),
          .settings = stage_settings(input)};
}

std::string k0_name(const std::vector<GroundLayer>& layers, std::size_t layer) {
  return layers.size() == 1 ? "k0" : "k0_" + layers[layer].region;
}

std::vector<io::TableColumn> k0_columns(const K0Table& k0) {
  return {{"vertical_stress", "Pa", k0.stress()}, {"ratio", "-", k0.ratio()}};
}

ColumnResult measure_k0(const ColumnSetup& setup, const RunOptions& options, const io::Provenance& provenance,
                        RunLog& log) {
  Scene scene = column_scene(setup);
  const std::vector<StagePlan> plans = plan_stages(scene);
  GroundRun run(options, provenance, scene.mesh, column_data(scene.mesh, setup), setup.settings, log);
  std::vector<ColumnRow> rows;
  if (const io::Checkpoint* checkpoint = run.recorder().resumed()) rows = rows_from(*checkpoint);
  if (!run.finished()) {
    run.open_ground(setup.material, [&log](const std::string& text) { log.line(text); });
    const RunStatus status = run_stages(
        run, scene, plans, nullptr,
        {.on_start = {}, .complete = [&](const StagePlan&, Stage& stage) { add_rows(stage, scene.mesh, rows); }});
    if (status != RunStatus::finished) return {status, {}, run.recorder().totals()};
  }
  std::vector<K0Table> k0 = write_tables(setup, scene.mesh, rows, run);
  return {RunStatus::finished, std::move(k0), run.recorder().totals()};
}

ColumnResult run_own_column(ColumnSetup setup, const Case& input, const RunOptions& options, RunLog& log) {
  RunOptions own = options;
  own.folder /= "column";
  // Not the folder of the run as well, which may have been moved since it was locked.
  std::filesystem::create_directory(own.folder);
  setup.settings.output.rves.clear();  // these numbers are points of the larger mesh
  return measure_k0(setup, own, provenance_of(own, input, "column"), log);
}

}  // namespace voussoir::host
