#include "host/scene/run_scene.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "host/record/provenance.hpp"
#include "host/record/remarks.hpp"
#include "host/scene/boundary_columns.hpp"
#include "host/scene/k0_column.hpp"
#include "host/scene/run_stages.hpp"
#include "host/scene/scene_of.hpp"
#include "host/stages/confirm_mesh.hpp"
#include "host/stages/ground_record.hpp"
#include "host/stages/ground_run.hpp"

namespace voussoir::host {
namespace {

io::MeshData data_of(const PlannedScene& planned) {
  const Scene& scene = planned.scene;
  io::MeshData data = mesh_data(scene.mesh, BoundaryNames::of_mesh);
  const Eigen::RowVectorXd y = scene.mesh.coordinates.row(1);
  data.geometry = {{"surface_y", y.maxCoeff()}, {"surcharge", scene.pressure}};
  if (scene.input.regions.size() == 1) data.geometry["unit_weight"] = scene.input.regions.front().unit_weight;
  const SceneMeshCase& mesh = scene.input.mesh;
  if (mesh.shape == MeshShape::half_tunnel || mesh.shape == MeshShape::tunnel) {
    data.geometry["diameter"] = mesh.diameter;
    data.geometry["axis_depth"] = (mesh.cover_ratio + 0.5) * mesh.diameter;
  }
  return data;
}

/// The columns of a scene: those of the last converged step, which a stage gives to its increments.
class SceneColumns {
 public:
  SceneColumns(const PlannedScene& planned, const Ground& ground)
      : boundaries_(watched(planned.plans)), records_(planned.records), ground_(ground) {}

  /// Columns of a state whose reactions were integrated on these coordinates, with its tensile_nodes.
  [[nodiscard]] io::Quantities of(const StagePlan& plan, const Eigen::VectorXd& reactions,
                                  const fem::Coordinates& coordinates, const NodesByName& pulled) const {
    io::Quantities columns;
    add_boundary_columns(boundaries_, plan, ground_, reactions, coordinates, pulled, columns);
    add_record_columns(records_, plan, reactions, ground_, columns);
    return columns;
  }

  void complete(const StagePlan& plan, Stage& stage) {
    stage.on_step = [this, &plan](const fem::ConvergedStep& step) {
      if (!step.target) return;
      reactions_ = step.increment.reactions;
      coordinates_ = step.state.coordinates;
      if (kinematics_of(plan) == fem::Kinematics::updated_lagrangian)
        coordinates_ -= step.increment.last_part.reshaped(2, coordinates_.cols());
    };
    stage.on_record = [this, &plan](IncrementReport& increment) {
      const NodesByName pulled = tensile_nodes(ground_.mesh, plan, reactions_, coordinates_);
      for (const auto& [name, quantity] : of(plan, reactions_, coordinates_, pulled))
        increment.info.extra[name] = quantity;
      for (const auto& [name, nodes] : pulled) pulled_[name] = std::max(pulled_[name], nodes.size());
      if (shrinks(plan)) increment.volume_loss = increment.info.extra.at("area_" + *shrinks(plan)).value;
    };
  }

  /// A sentence where supports have pulled the ground, which a cohesionless ground cannot bear; empty otherwise.
  [[nodiscard]] std::string tension_sentence() const {
    std::string list;
    for (const auto& [name, count] : pulled_) {
      if (count == 0) continue;
      list += fmt::format("{}{} ({} node{} at the most)", list.empty() ? "" : ", ", name, count, count == 1 ? "" : "s");
    }
    if (list.empty()) return {};
    return fmt::format("supports pulled the ground at {}: where it has no cohesion, a real boundary would part from it",
                       list);
  }

 private:
  /// The boundary that loses area in this stage.
  [[nodiscard]] static std::optional<std::string> shrinks(const StagePlan& plan) {
    for (const Holder& holder : plan.holders) {
      if (holder.is_boundary && holder.move.area && *holder.move.area < 0) return holder.name;
    }
    return {};
  }

  WatchedBoundaries boundaries_;
  const std::vector<PlacedRecord>& records_;
  const Ground& ground_;
  Eigen::VectorXd reactions_;
  fem::Coordinates coordinates_;
  std::map<std::string, std::size_t> pulled_;  ///< by name, the most of all increments
};

MaterialCase scene_material(const Case& input) {
  MaterialCase material = material_case(input);
  material.regions = input.scene.regions;
  return material;
}

/// K0 of the scene's layers from a column of its own; the tables are copied to the run.
ColumnResult measure_rest(const Case& input, const PlannedScene& planned, const RunOptions& options, RunLog& log) {
  if (planned.layers.empty()) return {};
  const ColumnSetup setup{.column = input.column,
                          .layers = planned.layers,
                          .surcharge = planned.scene.pressure,
                          .gravity = input.gravity,
                          .material = scene_material(input),
                          .settings = stage_settings(input)};
  return run_own_column(setup, input, options, log);
}

void write_tables(const PlannedScene& planned, const ColumnResult& column, GroundRun& run) {
  for (std::size_t layer = 0; layer < column.k0.size(); ++layer) {
    run.recorder().set_table(k0_name(planned.layers, layer), k0_columns(column.k0[layer]));
  }
}

void write_lines(const PlannedScene& planned, GroundRun& run) {
  for (const PlacedRecord& record : planned.records) {
    if (!record.input.line) continue;
    run.recorder().set_table("line_" + record.input.name,
                             line_table(record, planned.scene.mesh, planned.plans, run.recorder().folder()));
  }
}

RunStatus run_all(const Case& input, PlannedScene& planned, const ColumnResult& column, GroundRun& run) {
  write_tables(planned, column, run);
  run.open_ground(scene_material(input), [&](const std::string& text) {
    if (column.k0.empty()) {
      run.log().line(text);
    } else {
      run.log().detail(text);  // the column has said it
    }
  });
  const GroundAtRest rest{.layers = planned.layers, .k0 = column.k0, .pressure = planned.scene.pressure};
  SceneColumns columns(planned, run.ground());
  StageAdditions additions;
  additions.on_start = [&](const StagePlan& plan, const SceneLoads& loads, const FadingForces& forces) {
    const Eigen::VectorXd reactions = loads.reactions(0, forces);
    const fem::Coordinates& x = run.ground().state.coordinates;
    const NodesByName pulled = tensile_nodes(run.ground().mesh, plan, reactions, x);
    record_stage_start(run, plan, reactions, columns.of(plan, reactions, x, pulled));
  };
  additions.complete = [&](const StagePlan& plan, Stage& stage) { columns.complete(plan, stage); };
  const RunStatus status = run_stages(run, planned.scene, planned.plans, column.k0.empty() ? nullptr : &rest,
                                      additions);
  if (const std::string tension = columns.tension_sentence(); !tension.empty()) run.log().warning(tension);
  if (status != RunStatus::interrupted) write_lines(planned, run);
  return status;
}

}  // namespace

RunStatus run_scene(const Case& input, const RunOptions& options) {
  PlannedScene planned = planned_scene(input);
  const io::MeshData data = data_of(planned);
  confirm_mesh(data, options, "mesh.file");
  RunLog log = open_log(options);
  tell_circumstances(options, log);
  GroundRun run(options, provenance_of(options, input, "scene"), planned.scene.mesh, data, stage_settings(input), log);
  if (run.finished()) {
    write_lines(planned, run);
    run.report_finished();
    return RunStatus::finished;
  }
  log.line(fmt::format("{}: the mesh has {} elements and {} points", input.name, planned.scene.mesh.n_elements(),
                       planned.scene.mesh.n_points()));
  log_engine(input, log);
  say_remarks(input, log);
  const ColumnResult column = measure_rest(input, planned, options, log);
  RunStatus status = column.status;
  if (status == RunStatus::finished) status = run_all(input, planned, column, run);
  std::vector<StageTotals> totals = column.totals;
  totals.insert(totals.end(), run.recorder().totals().begin(), run.recorder().totals().end());
  for (const std::string& line : totals_table(totals)) log.line(line);
  return status;
}

}  // namespace voussoir::host
