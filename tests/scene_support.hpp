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

namespace voussoir::scene_support {

inline host::SupportCase support(std::vector<std::string> boundaries, const std::string& axes) {
  return {.boundaries = std::move(boundaries),
          .point = {},
          .x = axes.find('x') != std::string::npos,
          .y = axes.find('y') != std::string::npos};
}

inline host::SupportCase point_support(host::PlaceCase point, const std::string& axes) {
  host::SupportCase one = support({}, axes);
  one.point = std::move(point);
  return one;
}

inline host::MoveCase move_by(const std::string& boundary, std::optional<double> x, std::optional<double> y) {
  host::MoveCase move;
  move.boundary = boundary;
  move.x = x;
  move.y = y;
  return move;
}

inline host::MoveCase affine(const std::string& boundary, double rotation, double area, fem::Point about) {
  host::MoveCase move;
  move.boundary = boundary;
  move.rotation = rotation;
  move.area = area;
  move.about.at = {about.x(), about.y()};
  return move;
}

inline host::PressCase pressure_on(const std::string& boundary, double pressure) {
  return {.boundary = boundary, .kind = host::PressKind::pressure, .pressure = pressure, .traction = {}};
}

inline host::PressCase traction_on(const std::string& boundary, double tx, double ty) {
  return {.boundary = boundary, .kind = host::PressKind::traction, .pressure = 0, .traction = {tx, ty}};
}

inline host::PressCase at_rest_on(const std::string& boundary) {
  return {.boundary = boundary, .kind = host::PressKind::at_rest, .pressure = 0, .traction = {}};
}

/// A stage of one step without changes; on a fixed mesh, where linear elastic ground is nearly linear.
inline host::StageCase stage(const std::string& name, int steps = 1) {
  host::StageCase one;
  one.name = name;
  one.steps = steps;
  one.geometry = host::LossGeometry::fixed_mesh;
  return one;
}

inline host::StageCase gravity_stage(double factor = 1.0) {
  host::StageCase one = stage("gravity", 0);
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
inline host::Scene scene_on(fem::Mesh mesh, double unit_weight, double pressure = 1e3) {
  host::Scene scene{.input = {}, .mesh = std::move(mesh), .pressure = pressure};
  const std::vector<std::string> names = scene.mesh.region_names.empty() ? std::vector<std::string>{"ground"}
                                                                         : scene.mesh.region_names;
  for (const std::string& name : names) {
    host::RegionCase region;
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
  host::Scene scene;
  double young = 5e7, poisson = 0.3;
  double tolerance = 1e-10;
  const host::GroundAtRest* rest = nullptr;
  bool resume = false;
  std::function<void(const host::StagePlan&, int increment)> on_increment = {};  ///< may throw, as a run that is killed
  std::function<void(const host::StagePlan&)> on_start = {};                     ///< the same

  /// Runs into a folder that is emptied before, or goes on there.
  std::vector<StageEnd> run(const std::filesystem::path& folder) {
    if (!resume) std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    host::Case input;
    input.kind = host::CaseKind::scene;
    input.fingerprint = "scene_support";
    input.newton.tolerance = tolerance;
    input.newton.displacement_tolerance = 1e-6;
    input.newton.initial_tangent_fraction = 0;
    input.packing.pressure = scene.pressure;
    host::RunLog log(folder / "run.log", resume);
    host::RunOptions options{.folder = folder, .resume = resume, .command = "test"};
    host::Scene now = scene;
    const std::vector<host::StagePlan> plans = host::plan_stages(now);
    host::GroundRun run(options, host::provenance_of(options, input, "scene"), now.mesh, host::mesh_data(now.mesh),
                        host::stage_settings(input), log);
    host::MaterialCase material = host::material_case(input);
    material.kind = host::MaterialKind::linear_elastic;
    material.elastic = {.modulus = young, .poisson = poisson};
    material.regions = now.input.regions;
    run.open_ground(material, [](const std::string&) {});
    std::vector<StageEnd> ends;
    const host::RunStatus status = host::run_stages(run, now, plans, rest, additions(run, ends));
    if (status != host::RunStatus::finished) throw std::runtime_error("the scene did not finish");
    return ends;
  }

 private:
  host::StageAdditions additions(host::GroundRun& run, std::vector<StageEnd>& ends) const {
    host::StageAdditions more;
    more.on_start = [&](const host::StagePlan& plan, const host::SceneLoads& loads, const host::FadingForces& forces) {
      host::record_stage_start(run, plan, loads.reactions(0, forces), {});
      if (on_start) on_start(plan);
    };
    more.complete = [&](const host::StagePlan& plan, host::Stage& stage) {
      ends.emplace_back();
      stage.on_step = [&run, &end = ends, last = plan.targets.back()](const fem::ConvergedStep& step) {
        if (step.to != last) return;
        end.back() = {.coordinates = step.state.coordinates,
                      .displacement = run.ground().total_displacement(),
                      .reactions = step.increment.reactions,
                      .external = step.increment.external_force,
                      .stress = step.increment.stress};
      };
      stage.on_record = [this, &plan](host::IncrementReport& report) {
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

}  // namespace voussoir::scene_support
