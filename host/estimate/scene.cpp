#include "host/estimate/scene.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "fem/gauss_points.hpp"
#include "host/estimate/evaluation.hpp"
#include "host/packing/case_recipes.hpp"
#include "host/packing/packings.hpp"
#include "host/scene/describe_scene.hpp"
#include "host/scene/scene_of.hpp"

namespace voussoir::host {
namespace {

/// The regions of the case with their points; a mesh without names is one region.
std::vector<RegionSize> regions_of(const Case& input, const fem::Mesh& mesh) {
  std::vector<RegionSize> all;
  for (std::size_t k = 0; k < input.scene.regions.size(); ++k) {
    const RegionCase& region = input.scene.regions[k];
    const bool has_grains = input.material == MaterialKind::grains && !region.elastic;
    for (const std::string& name : region.names)
      all.push_back({.name = name,
                     .table = k,
                     .unit_weight = region.unit_weight,
                     .variety = has_grains ? region.packing.variety : 0,
                     .grains = has_grains ? region.packing.grains : 0});
  }
  for (int e = 0; e < mesh.n_elements(); ++e) {
    for (RegionSize& size : all) {
      if (mesh.in_region(e, size.name)) size.points += 4;
    }
  }
  return all;
}

/// The largest extent of a boundary, or of the whole mesh where it is not named [m].
double extent_of(const fem::Mesh& mesh, const std::string& boundary) {
  const auto found = mesh.nodes.find(boundary);
  if (found == mesh.nodes.end() || found->second.empty())
    return (mesh.coordinates.rowwise().maxCoeff() - mesh.coordinates.rowwise().minCoeff()).norm();
  fem::Point low = mesh.coordinates.col(found->second.front()), high = low;
  for (const int node : found->second) {
    low = low.cwiseMin(mesh.coordinates.col(node));
    high = high.cwiseMax(mesh.coordinates.col(node));
  }
  return (high - low).norm();
}

/// The largest displacement that a move gives to its boundary [m].
double largest_motion(const MoveCase& move, const fem::Mesh& mesh) {
  const double translation = std::hypot(move.x.value_or(0.0), move.y.value_or(0.0));
  if (!move.is_affine()) return translation;
  const double stretch = std::abs(std::sqrt(std::max(1 + move.area.value_or(0.0), 0.0)) - 1);
  return translation + (stretch + std::abs(move.rotation.value_or(0.0))) * extent_of(mesh, move.boundary);
}

/// Evaluations of the full number of steps over the stage, and the mean strain of each.
struct StageWork {
  double evaluations = 0;
  double strain = 0;
};

StageWork work_of(const StageCase& stage, const Case& input, const fem::Mesh& mesh, std::size_t steps) {
  const auto n = static_cast<double>(steps);
  if (stage.only_gravity()) return {gravity_evaluations * n, gravity_strain * input.gravity.uniform_step};
  double motion = 0, area = 0;
  for (const MoveCase& move : stage.moves) motion = std::max(motion, largest_motion(move, mesh));
  for (const double a : fem::gauss_points(mesh, mesh.coordinates).volumes) area += a;
  const bool is_loaded = !stage.presses.empty() || !stage.releases.empty() || !stage.excavations.empty();
  return {loss_evaluations * n, std::max(motion / std::sqrt(area), is_loaded ? gravity_strain : 0.0) / n};
}

/// The number of different packings that the regions' recipes make or read.
std::size_t packings_of(const Case& input) {
  std::set<std::string> all;
  for (const SoilRecipe& recipe : recipes_of(input)) {
    for (const auto& file : recipe.packing->files) all.insert(file.string());
    if (!recipe.packing->files.empty()) continue;
    for (const std::int64_t seed : seeds_of(*recipe.packing))
      all.insert(stored_path(*recipe.soil, *recipe.packing, seed).string());
  }
  return all.size();
}

}  // namespace

CaseSize scene_size(const Case& input) {
  const PlannedScene planned = planned_scene(input);
  const fem::Mesh& mesh = planned.scene.mesh;
  CaseSize size;
  size.sentences = describe(input, planned);
  size.points = static_cast<std::size_t>(mesh.n_points());
  size.nodes = static_cast<std::size_t>(mesh.n_nodes());
  size.height = mesh.coordinates.row(1).maxCoeff() - mesh.coordinates.row(1).minCoeff();
  size.regions = regions_of(input, mesh);
  size.packings = packings_of(input);
  const double pressure = input.packing.pressure + 0.5 * weight_stress(planned.scene);
  for (const RegionSize& region : size.regions)
    size.grains += region.variety > 0 ? static_cast<double>(region.points) * region.grains : 0.0;
  for (const StagePlan& plan : planned.plans) {
    const std::size_t steps = plan.targets.size();
    const StageWork work = work_of(plan.input, input, mesh, steps);
    size.increments += steps;
    for (const RegionSize& region : size.regions) {
      if (region.variety == 0) continue;
      size.particle_steps += static_cast<double>(region.points) * region.grains * work.evaluations *
                             steps_per_evaluation(input.scene.regions[region.table].soil, input.engine, work.strain,
                                                  pressure);
    }
  }
  return size;
}

double share_of_lanes(const std::vector<RegionSize>& regions, int width) {
  const auto lanes = static_cast<std::size_t>(width);
  std::size_t held = 0, there = 0;
  for (const RegionSize& region : regions) {
    const auto packings = static_cast<std::size_t>(region.variety);
    for (std::size_t k = 0; k < packings; ++k) {  // packings are dealt out in turn
      const std::size_t n = region.points / packings + (k < region.points % packings ? 1 : 0);
      held += n;
      there += (n + lanes - 1) / lanes * lanes;
    }
  }
  return there == 0 ? 1.0 : static_cast<double>(held) / static_cast<double>(there);
}

}  // namespace voussoir::host
