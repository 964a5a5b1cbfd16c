#include "host/kinds/biaxial_bvp.hpp"

#include <spdlog/fmt/fmt.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <limits>

#include "fem/mesh_rectangle.hpp"
#include "host/record/provenance.hpp"
#include "host/record/remarks.hpp"
#include "host/scene/run_stages.hpp"
#include "host/stages/ground_record.hpp"
#include "host/stages/ground_run.hpp"
#include "io/result_file.hpp"

namespace voussoir::host {
namespace {

io::MeshData specimen_data(const fem::Mesh& mesh, const BiaxialBvpCase& test) {
  io::MeshData data = mesh_data(mesh);
  data.geometry = {{"width", test.width}, {"height", test.height}};
  return data;
}

/// Table `gauss_histories` of docs/reference/files.md. It is gathered from the files of the increments, which a resumed
/// run has all. Since a run may be resumed with other `output.fields`, a file may lack a field; its values are NaN
/// then.
std::vector<io::TableColumn> gauss_histories(const std::filesystem::path& folder) {
  struct Source {
    const char* field;
    std::array<const char*, 3> columns;
  };
  static constexpr std::array<Source, 7> sources{{{"strain", {"strain_xx", "strain_yy", "strain_xy"}},
                                                  {"stress", {"stress_xx", "stress_yy", "stress_xy"}},
                                                  {"mean_stress", {"p"}},
                                                  {"deviatoric_stress", {"q"}},
                                                  {"volumetric_strain", {"volumetric_strain"}},
                                                  {"deviatoric_strain", {"deviatoric_strain"}},
                                                  {"void_ratio", {"void_ratio"}}}};
  constexpr double missing = std::numeric_limits<double>::quiet_NaN();
  std::vector<io::TableColumn> table{{"load_parameter", "-", {}}, {"point", "-", {}}};
  std::map<std::string, std::size_t> column_of;
  for (const io::IncrementInfo& info : io::read_increments(folder / "run.h5")) {
    std::size_t points = 0;
    for (const io::Field& field : io::read_fields(io::increment_path(folder, info.index))) {
      if (field.location != io::FieldLocation::gauss) continue;
      const auto components = static_cast<std::size_t>(field.components);
      points = field.values.size() / components;
      for (const Source& source : sources) {
        if (field.name != source.field) continue;
        for (std::size_t k = 0; k < components; ++k) {
          const auto [at, is_new] = column_of.try_emplace(source.columns[k], table.size());
          if (is_new)
            table.push_back({source.columns[k], field.unit, std::vector<double>(table[0].values.size(), missing)});
          for (std::size_t p = 0; p < points; ++p) table[at->second].values.push_back(field.values[p * components + k]);
        }
      }
    }
    for (std::size_t p = 0; p < points; ++p) {
      table[0].values.push_back(info.load_parameter);
      table[1].values.push_back(static_cast<double>(p));
    }
    for (io::TableColumn& column : table) column.values.resize(table[0].values.size(), missing);
  }
  return table;
}

/// A sentence with the mean costs of the increments, read from the run's own results.
std::string cost_line(const std::filesystem::path& folder) {
  const std::vector<io::IncrementInfo> all = io::read_increments(folder / "run.h5");
  double evaluations = 0, work = 0, wall = 0;
  for (const io::IncrementInfo& info : all) {
    evaluations += info.evaluations;
    work += info.particle_steps;
    wall += info.wall_s;
  }
  const auto n = static_cast<double>(all.size());
  return fmt::format(
      "an increment took {1:.1f} evaluations, {2:.3g} particle-steps and {3:.3g} s in the mean of {0} increments",
      all.size(), evaluations / n, work / n, wall / n);
}

/// Gives the stage its columns. `mesh` and `specimen` must outlive it.
void add_specimen_columns(Stage& stage, const fem::Mesh& mesh, SpecimenState& specimen) {
  stage.on_step = [&mesh, &specimen](const fem::ConvergedStep& step) {
    specimen = specimen_state(mesh, step.increment, step.state);
  };
  stage.on_record = [&specimen](IncrementReport& increment) {
    add_columns(specimen, specimen_columns, increment.info.extra);
  };
}

}  // namespace

Scene specimen_scene(const BiaxialBvpCase& test) {
  Scene scene{.input = {},
              .mesh = fem::make_rectangle(test.width, test.height, test.columns, test.rows),
              .pressure = test.pressure,
              .gravity = {}};
  RegionCase ground;
  ground.unit_weight = 0;
  scene.input.regions = {ground};
  scene.input.supports = {{.boundaries = {"base"}, .point = {}, .y = true},
                          {.boundaries = {}, .point = {.name = "", .at = {0, 0}}, .x = true}};
  StageCase stage;
  stage.name = "biaxial_bvp";
  stage.end = test.strain;
  stage.steps = test.increments();
  MoveCase top;
  top.boundary = "top";
  top.y = -test.height;  // at a strain of 1
  stage.moves = {top};
  scene.input.stages = {stage};
  return scene;
}

SpecimenState specimen_state(const fem::Mesh& mesh, const fem::Increment& increment, const fem::MeshState& state) {
  SpecimenState specimen;
  const std::vector<int>& top = mesh.node_set("top");
  for (const int node : top) specimen.axial_force -= increment.reactions[2 * node + 1];
  const auto x_before = [&](int node) { return state.coordinates(0, node) - increment.last_part[2 * node]; };
  specimen.axial_stress = specimen.axial_force / std::abs(x_before(top.front()) - x_before(top.back()));
  const double base = mesh.coordinates(1, mesh.node_set("base").front());
  specimen.axial_strain = -std::log((state.coordinates(1, top.front()) - base) /
                                    (mesh.coordinates(1, top.front()) - base));
  const std::vector<double> now = fem::gauss_points(mesh, state.coordinates).volumes;
  const std::vector<double> first = fem::gauss_points(mesh, mesh.coordinates).volumes;
  double area = 0, first_area = 0;
  fem::PlaneTensor stress = fem::PlaneTensor::Zero();
  for (std::size_t p = 0; p < now.size(); ++p) {
    area += now[p];
    first_area += first[p];
    stress += now[p] * increment.stress[p];
  }
  specimen.volumetric_strain = -std::log(area / first_area);
  stress /= area;
  specimen.p = fem::mean_stress(stress);
  specimen.q = fem::deviatoric_stress(stress);
  specimen.q_over_p = specimen.p != 0 ? specimen.q / specimen.p : 0.0;
  return specimen;
}

RunStatus run_biaxial_bvp(const Case& input, const RunOptions& options) {
  const BiaxialBvpCase& test = input.biaxial_bvp;
  Scene scene = specimen_scene(test);
  const fem::Mesh& mesh = scene.mesh;
  RunLog log = open_log(options);
  tell_circumstances(options, log);
  GroundRun run(options, provenance_of(options, input, "biaxial_bvp"), mesh, specimen_data(mesh, test),
                stage_settings(input), log);
  if (run.finished()) {
    // The disk may have been full between the last checkpoint and this table, which a run that has it keeps.
    run.recorder().set_table("gauss_histories", gauss_histories(options.folder));
    run.report_finished();
    return RunStatus::finished;
  }
  log_engine(input, log);
  say_remarks(input, log);
  MaterialCase material = material_case(input);
  material.packing.pressure = test.pressure;
  run.open_ground(material, [&log](const std::string& text) { log.line(text); });
  SpecimenState specimen;
  const RunStatus status = run_stages(run, scene, plan_stages(scene), nullptr,
                                      {.on_start = {}, .complete = [&](const StagePlan&, Stage& stage) {
                                         add_specimen_columns(stage, mesh, specimen);
                                       }});
  if (status == RunStatus::interrupted || run.ground().state.parameter == 0) return status;
  run.recorder().set_table("gauss_histories", gauss_histories(options.folder));
  log.line(cost_line(options.folder));
  return status;
}

}  // namespace voussoir::host
