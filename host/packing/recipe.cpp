#include "host/packing/recipe.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <utility>

#include "host/packing/consolidation.hpp"
#include "host/packing/grading.hpp"
#include "host/packing/stored_packing.hpp"
#include "host/process/exit_code.hpp"
#include "io/packing_file.hpp"

namespace voussoir::host {

namespace {

constexpr int recipe_version = 2;  ///< to be raised when a change here or in the engine changes packings
constexpr double loose_solid_fraction = 0.45;
constexpr int placement_tries = 20000;

bool overlaps(const PackedRve& rve, std::size_t placed, double x, double y, double side) {
  for (std::size_t j = 0; j < placed; ++j) {
    double dx = x - rve.position[2 * j], dy = y - rve.position[2 * j + 1];
    dx -= side * std::nearbyint(dx / side);
    dy -= side * std::nearbyint(dy / side);
    const double reach = rve.packing.radii[placed] + rve.packing.radii[j];
    if (dx * dx + dy * dy < reach * reach) return true;
  }
  return false;
}

/// Places the grains at random in a square cell, one after another, the largest first.
void place_loose(PackedRve& rve, Uniform& uniform) {
  const double side = std::sqrt(rve.packing.solid_area() / loose_solid_fraction);
  rve.cell = {side, 0, 0, side};
  const std::size_t n = rve.packing.radii.size();
  rve.position.assign(2 * n, 0.0);
  rve.rotation.assign(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    int tries = 0;
    double x = 0, y = 0;
    do {
      x = side * uniform();
      y = side * uniform();
    } while (overlaps(rve, i, x, y, side) && ++tries < placement_tries);
    if (tries == placement_tries) throw NoEquilibrium("the cell has no room left to place a grain at random");
    rve.position[2 * i] = x;
    rve.position[2 * i + 1] = y;
  }
}

PackedRve loose_packing(const SoilCase& soil, const PackingCase& recipe, std::int64_t seed) {
  PackedRve rve;
  rve.seed = seed;
  rve.packing = packing_of(soil, sample_radii(soil, recipe.grains, seed), soil.thickness);
  Uniform uniform(seed + 1000003);
  place_loose(rve, uniform);
  return rve;
}

}  // namespace

std::vector<PackedRve> make_packings(const SoilCase& soil, const PackingCase& recipe,
                                     std::span<const std::int64_t> seeds) {
  std::vector<PackedRve> loose(seeds.size());
  for (std::size_t k = 0; k < seeds.size(); ++k) {
    loose[k] = loose_packing(soil, recipe, seeds[k]);
    loose[k].consolidation_friction = recipe.consolidation_friction;
    loose[k].consolidation_rolling = recipe.consolidation_rolling;
  }
  if (loose.empty()) return loose;
  return recipe.void_ratio > 0 ? settle_at_void_ratio(std::move(loose), recipe.pressure, recipe.void_ratio)
                               : settle(loose, recipe.pressure);
}

std::vector<PackedRve> settle_foreign_packings(const SoilCase& soil, const PackingCase& recipe) {
  std::vector<PackedRve> rves;
  for (const std::filesystem::path& file : recipe.files) rves.push_back(grains_from(io::load_packing_csv(file), soil));
  rest_at(recipe.pressure, rves);
  return rves;
}

std::string recipe_text(const SoilCase& soil, const PackingCase& recipe, std::int64_t seed) {
  std::string text = fmt::format("recipe {} d {} {} damping {} t {} grains {} mu_t {} p {} seed {}", recipe_version,
                                 soil.size_minimum, soil.size_maximum, soil.damping, soil.thickness, recipe.grains,
                                 recipe.consolidation_friction, recipe.pressure, seed);
  if (recipe.void_ratio > 0) text += fmt::format(" e {}", recipe.void_ratio);
  // Without friction there is no torque and hence no rolling, so that the key does not matter.
  if (!recipe.consolidation_rolling && (recipe.consolidation_friction > 0 || recipe.void_ratio > 0)) {
    text += " rolling 0";
  }
  for (const kernels::GrainMaterial& m : grain_materials(soil)) {
    for (const auto& [name, number] : kernels::material_numbers) text += fmt::format(" {} {}", name, m.*number);
  }
  for (const GrainClassCase& grains : soil.classes) text += fmt::format(" to {}", grains.size_to);
  for (std::size_t k = 0; k < soil.sizes.size(); ++k) text += fmt::format(" {}:{}", soil.sizes[k], soil.passing[k]);
  return text + (soil.passing_by == GradingMeasure::area ? " by area" : " by number");
}

}  // namespace voussoir::host
