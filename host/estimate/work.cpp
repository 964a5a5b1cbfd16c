#include "host/estimate/work.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/element_tests/calibration.hpp"
#include "host/estimate/evaluation.hpp"
#include "host/estimate/scene.hpp"
#include "host/estimate/storage.hpp"
#include "host/kinds/tunnel_mesh.hpp"
#include "host/packing/packings.hpp"
#include "host/scene/scene.hpp"

namespace voussoir::host {
namespace {

constexpr double specimen_evaluations = 2.5;  ///< of the full number of steps; cases/biaxial_bvp took 7 in all
constexpr double specimen_strain = 1.4;  ///< norm of an RVE's strain over the strain of the specimen, without change of
                                         ///< volume

CaseSize probe_size(const ProbeCase& probe, const SoilCase& soil, const PackingCase& recipe, const EngineCase& engine) {
  double steps = 6.0 * steps_per_evaluation(soil, engine, probe.strain, probe.pressure);
  for (const PathSegment& segment : probe.path) {
    const auto& g = segment.gradient;
    const double strain = std::sqrt(g[0] * g[0] + g[3] * g[3] + 0.5 * (g[1] + g[2]) * (g[1] + g[2]));
    steps += segment.increments * steps_per_evaluation(soil, engine, strain, probe.pressure);
  }
  const std::size_t copies = count_of_packings(recipe) * static_cast<std::size_t>(probe.replicas);
  CaseSize size;
  size.tests = 6 * copies;
  size.particle_steps = static_cast<double>(copies) * recipe.grains * steps;
  return size;
}

CaseSize biaxial_size(const BiaxialCase& test, const SoilCase& soil, const PackingCase& recipe) {
  CaseSize size;
  for (const double pressure : test.pressures) {
    const double steps = inertial_steps(soil, test.strain, pressure, test.inertial_number);
    size.particle_steps += static_cast<double>(count_of_packings(recipe)) * recipe.grains * steps;
  }
  size.tests = count_of_packings(recipe) * test.pressures.size();
  return size;
}

CaseSize specimen_size(const BiaxialBvpCase& test, MaterialKind material, const SoilCase& soil,
                       const PackingCase& recipe, const EngineCase& engine) {
  CaseSize size;
  size.points = 4 * static_cast<std::size_t>(test.columns) * static_cast<std::size_t>(test.rows);
  size.increments = static_cast<std::size_t>(test.increments());
  if (material != MaterialKind::grains) return size;
  size.grains = static_cast<double>(size.points) * recipe.grains;
  size.particle_steps = size.grains * specimen_evaluations * test.increments() *
                        steps_per_evaluation(soil, engine, specimen_strain * test.strain_step, 2 * test.pressure);
  return size;
}

/// The size of a calibration: its grid, refinements and confirmation.
CaseSize search_size(const CalibrateCase& search, const BiaxialCase& test, const SoilCase& given,
                     const PackingCase& recipe) {
  const SearchBox box(search, given);
  const std::vector<ParameterSet> grid = box.grid();
  const std::size_t stars = static_cast<std::size_t>(search.rounds) * (2 * box.dimensions() + 1);
  const std::size_t seeds = seeds_of(recipe).size();
  CaseSize size;
  size.tests = ((grid.size() + stars) * seeds + 2 * search.confirm_seeds.size()) * test.pressures.size();
  const double thickness_of_grid = std::accumulate(grid.begin(), grid.end(), 0.0,
                                                   [](double sum, const ParameterSet& set) {
                                                     return sum + set[Parameter::thickness];
                                                   }) /
                                   static_cast<double>(grid.size());
  SoilCase soil = given;
  soil.thickness = thickness_of_grid;
  for (const double pressure : test.pressures) {
    const double steps = inertial_steps(soil, test.strain, pressure, 1.0);
    size.particle_steps += steps / test.inertial_number * recipe.grains *
                           static_cast<double>((grid.size() + stars) * seeds);
    size.particle_steps += steps / search.confirm_inertial_number * search.confirm_grains * 2.0 *
                           static_cast<double>(search.confirm_seeds.size());
  }
  return size;
}

/// Increments of the column, and of a tunnel's gravity.
std::size_t gravity_increments(const GroundCase& ground, const GravityCase& gravity) {
  return gravity_targets(gravity, ground.surcharge / (ground.unit_weight * ground.height), 1.0).size();
}

CaseSize ground_size(const Case& input) {
  CaseSize size;
  const bool with_tunnel = input.kind == CaseKind::tunnel;
  const std::size_t gravity = gravity_increments(input.ground, input.gravity);
  const auto loss = with_tunnel ? static_cast<std::size_t>(input.volume_loss.increments) : std::size_t{0};
  size.column_points = 4 * static_cast<std::size_t>(input.column.elements);
  size.points = with_tunnel ? static_cast<std::size_t>(tunnel_mesh(input.ground).n_points()) : size.column_points;
  size.increments = with_tunnel ? 2 * gravity + loss : gravity;
  if (input.material != MaterialKind::grains) return size;

  const auto points = static_cast<double>(size.points);
  const double pressure = 0.5 * input.ground.unit_weight * input.ground.height;  // at half the depth
  const double under_gravity = gravity_evaluations * static_cast<double>(gravity) *
                               steps_per_evaluation(input.soil, input.engine,
                                                    gravity_strain * input.gravity.uniform_step, pressure);
  size.grains = points * input.packing.grains;
  size.particle_steps = size.grains * under_gravity;
  if (with_tunnel) {
    const double step = input.volume_loss.total / static_cast<double>(loss);
    size.particle_steps += static_cast<double>(size.column_points) * input.packing.grains * under_gravity;
    size.particle_steps += size.grains * loss_evaluations * static_cast<double>(loss) *
                           steps_per_evaluation(input.soil, input.engine, loss_strain * step, pressure);
  }
  return size;
}

}  // namespace

CaseSize case_size(const Case& input) {
  CaseSize size;
  if (input.kind == CaseKind::probe) size = probe_size(input.probe, input.soil, input.packing, input.engine);
  if (input.kind == CaseKind::biaxial) size = biaxial_size(input.biaxial, input.soil, input.packing);
  if (input.kind == CaseKind::biaxial_bvp)
    size = specimen_size(input.biaxial_bvp, input.material, input.soil, input.packing, input.engine);
  if (input.kind == CaseKind::calibrate) size = search_size(input.calibrate, input.biaxial, input.soil, input.packing);
  if (input.kind == CaseKind::scene) size = scene_size(input);
  if (input.kind == CaseKind::column || input.kind == CaseKind::tunnel) size = ground_size(input);
  add_storage(size, input);
  if (input.kind == CaseKind::biaxial || input.kind == CaseKind::calibrate) add_curves(size, input.biaxial);
  if (input.kind == CaseKind::scene) return size;
  size.packings = count_of_packings(input.packing) *
                  (input.kind == CaseKind::biaxial ? input.biaxial.pressures.size() : 1);
  return size;
}

}  // namespace voussoir::host
