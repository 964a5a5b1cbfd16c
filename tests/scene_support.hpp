#pragma once
/// Helpers of the scenes' tests: scenes that are written in C++, and their runs on linear elastic ground.

#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "fem/mesh_grid.hpp"
#include "host/record/provenance.hpp"
#include "host/scene/run_stages.hpp"
#include "host/stages/ground_record.hpp"

namespace voussoir::host {

inline SupportCase support(std::vector<std::string> boundaries, const std::string& axes) {
  return {.boundaries = std::move(boundaries),
          .point = {},
          .x = axes.find('x') != std::string::npos,
          .y = axes.find('y') != std::string::npos};
}

inline SupportCase point_support(PlaceCase point, const std::string& axes) {
  SupportCase one = support({}, axes);
  one.point = std::move(point);
  return one;
}

inline MoveCase move_by(const std::string& boundary, std::optional<double> x, std::optional<double> y) {
  MoveCase move;
  move.boundary = boundary;
  move.x = x;
  move.y = y;
  return move;
}

inline MoveCase affine(const std::string& boundary, double rotation, double area, fem::Point about) {
  MoveCase move;
  move.boundary = boundary;
  move.rotation = rotation;
  move.area = area;
  move.about.at = {about.x(), about.y()};
  return move;
}

inline PressCase pressure_on(const std::string& boundary, double pressure) {
  return {.boundary = boundary, .kind = PressKind::pressure, .pressure = pressure, .traction = {}};
}

inline PressCase traction_on(const std::string& boundary, double tx, double ty) {
  return {.boundary = boundary, .kind = PressKind::traction, .pressure = 0, .traction = {tx, ty}};
}

inline PressCase at_rest_on(const std::string& boundary) {
  return {.boundary = boundary, .kind = PressKind::at_rest, .pressure = 0, .traction = {}};
}

/// A stage of one step without changes; on a fixed mesh, where linear elastic ground is nearly linear.
inline StageCase stage(const std::string& name, int steps = 1) {
  StageCase one;
  one.name = name;
  one.steps = steps;
  one.geometry = LossGeometry::fixed_mesh;
  return one;
}

inline StageCase gravity_stage(double factor = 1.0) {
  StageCase one = stage("gravity", 0);
  one.gravity = factor;
  return one;
}

/// A rectangle from (0, 0) with the boundaries base, right, top and left; layers of equal height from the base up.
inline fem::Mesh grid(double width, double height, int columns, int rows, const std::vector<std::string>& layers) {
  fem::GridOptions options;
  options.x = {{0, width}, {columns}};
  options.y.breaks = {0};
  const auto n = static_cast<int>(layers.size());
  for (int k = 1; k <= n; ++k) {
    options.y.breaks.push_back(height * k / n);
    options.y.elements.push_back(rows / n);
  }
  options.layers = layers;
  return fem::make_grid(options);
}

/// A scene on this mesh; each region has a unit weight [N/m3].
inline Scene scene_on(fem::Mesh mesh, double unit_weight, double pressure = 1e3) {
  Scene scene{.input = {}, .mesh = std::move(mesh), .pressure = pressure};
  const std::vector<std::string> names = scene.mesh.region_names.empty() ? std::vector<std::string>{"ground"}
                                                                         : scene.mesh.region_names;
  for (const std::string& name : names) {
    RegionCase region;
    region.names = {name};
    region.unit_weight = unit_weight;
    scene.input.regions.push_back(region);
  }
  return scene;
}

/// The ground at the end of a stage.
struct StageEnd {
  fem::Coordinates coordinates;  ///< after it [m]
  Eigen::VectorXd displacement;  ///< the total [m]
  Eigen::VectorXd reactions;     ///< [N/m]
  Eigen::VectorXd external;      ///< all loads, without reactions [N/m]
  std::vector<fem::Stress> stress;
};

/// Runs of a scene with linear elastic ground, under its p0 at the start.
struct ElasticRun {
  Scene scene;
  double young = 5e7, poisson = 0.3;
  double tolerance = 1e-10;
  const GroundAtRest* rest = nullptr;
  bool resume = false;
  std::function<void(const StagePlan&, int increment)> on_increment = {};  ///< may throw, as a run that is killed
  std::function<void(const StagePlan&)> on_start = {};                     ///< the same

  /// Runs into a folder that is emptied before, or goes on there.
  std::vector<StageEnd> run(const std::filesystem::path& folder) {
    if (!resume) std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    Case input;
    input.kind = CaseKind::scene;
    input.fingerprint = "scene_support";
    input.newton.tolerance = tolerance;
    input.newton.displacement_tolerance = 1e-6;
    input.newton.initial_tangent_fraction = 0;
    input.packing.pressure = scene.pressure;
    RunLog log(folder / "run.log", resume);
    RunOptions options{.folder = folder, .resume = resume, .command = "test"};
    Scene now = scene;
    const std::vector<StagePlan> plans = plan_stages(now);
    GroundRun run(options, provenance_of(options, input, "scene"), now.mesh, mesh_data(now.mesh), stage_settings(input),
                  log);
    MaterialCase material = material_case(input);
    material.kind = MaterialKind::linear_elastic;
    material.elastic = {.modulus = young, .poisson = poisson};
    material.regions = now.input.regions;
    run.open_ground(material, [](const std::string&) {});
    std::vector<StageEnd> ends;
    const RunStatus status = run_stages(run, now, plans, rest, additions(run, ends));
    if (status != RunStatus::finished) throw std::runtime_error("the scene did not finish");
    return ends;
  }

 private:
  StageAdditions additions(GroundRun& run, std::vector<StageEnd>& ends) const {
    StageAdditions more;
    more.on_start = [&](const StagePlan& plan, const SceneLoads& loads, const FadingForces& forces) {
      record_stage_start(run, plan, loads.reactions(0, forces), {});
      if (on_start) on_start(plan);
    };
    more.complete = [&](const StagePlan& plan, Stage& stage) {
      ends.emplace_back();
      stage.on_step = [&run, &end = ends, last = plan.targets.back()](const fem::ConvergedStep& step) {
        if (step.to != last) return;
        end.back() = {.coordinates = step.state.coordinates,
                      .displacement = run.ground().total_displacement(),
                      .reactions = step.increment.reactions,
                      .external = step.increment.external_force,
                      .stress = step.increment.stress};
      };
      stage.on_record = [this, &plan](IncrementReport& report) {
        if (on_increment) on_increment(plan, report.info.stage_index);
      };
    };
    return more;
  }
};

/// The sum of nodal forces.
inline fem::Point total(const Eigen::VectorXd& forces) {
  fem::Point sum = fem::Point::Zero();
  for (Eigen::Index node = 0; node < forces.size() / 2; ++node) sum += forces.segment<2>(2 * node);
  return sum;
}

}  // namespace voussoir::host
