#include "host/packing/recipe.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <utility>

#include "host/packing/stored_packing.hpp"
#include "io/packing_file.hpp"

namespace voussoir::host {

namespace {

constexpr int recipe_version = 2;  ///< raise when a change here or in the engine changes packings
constexpr double loose_solid_fraction = 0.45;
constexpr int placement_tries = 20000;
constexpr int void_ratio_rounds = 8;           ///< of the bisection on the temporary friction
constexpr double void_ratio_tolerance = 0.01;  ///< of a wanted void ratio [-]

/// Uniform in [0, 1): the standard's distributions differ between libraries, the engine's bits do not.
class Uniform {
 public:
  explicit Uniform(std::int64_t seed) : engine_(static_cast<std::uint64_t>(seed)) {}
  double operator()() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }

 private:
  std::mt19937_64 engine_;
};

/// The grading curve as shares of the number of grains. Between two points of a curve by area the area is spread evenly
/// over sizes, so the number of grains between d1 and d goes with 1/d1 - 1/d.
class GradingByNumber {
 public:
  explicit GradingByNumber(const SoilCase& soil)
      : by_area_(!soil.sizes.empty() && soil.passing_by == GradingMeasure::area) {
    sizes_ = soil.sizes.empty() ? std::vector<double>{soil.size_minimum, soil.size_maximum} : soil.sizes;
    const std::vector<double> passing = soil.sizes.empty() ? std::vector<double>{0.0, 1.0} : soil.passing;
    below_.assign(1, 0.0);
    for (std::size_t k = 1; k < sizes_.size(); ++k) {
      const double share = passing[k] - passing[k - 1];
      below_.push_back(below_.back() + (by_area_ ? share / (sizes_[k - 1] * sizes_[k]) : share));
    }
    for (double& n : below_) n /= below_.back();
  }

  /// The size that a share `u` of all grains, 0 <= u <= 1, is smaller than [m].
  [[nodiscard]] double size_at(double u) const {
    std::size_t k = 1;
    while (k + 1 < below_.size() && below_[k] <= u) ++k;
    const double part = (u - below_[k - 1]) / (below_[k] - below_[k - 1]);
    if (!by_area_) return sizes_[k - 1] + part * (sizes_[k] - sizes_[k - 1]);
    return 1.0 / (1.0 / sizes_[k - 1] - part * (1.0 / sizes_[k - 1] - 1.0 / sizes_[k]));
  }

 private:
  bool by_area_;
  std::vector<double> sizes_;
  std::vector<double> below_;  ///< share of the number of grains below each size
};

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

/// Random sequential placement in a square cell, largest first.
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
    if (tries == placement_tries) throw std::runtime_error("no room to place the grains at random");
    rve.position[2 * i] = x;
    rve.position[2 * i + 1] = y;
  }
}

/// Largest strain per step so that the inertial number stays at 1e-3 once the pressure has been reached; the limits
/// keep packings of 100 Pa from taking forever and those of 1 MPa from closing on their overlaps.
double consolidation_rate(const kernels::Packing& packing, double pressure) {
  return std::clamp(1e-3 / packing.inertial_time(pressure), 2e-6, 2e-5);
}

/// All RVEs to rest under their isotropic pressure [Pa], each at `share` of its own rate, whoever is beside it.
std::vector<kernels::RveReport> consolidate(kernels::RveBatch& batch, double pressure, double share) {
  const kernels::ServoAxis axis{.stress_controlled = true, .target = -pressure};
  std::vector<kernels::ServoRequest> requests;
  for (std::size_t k = 0; k < batch.size(); ++k) {
    requests.push_back({.x = axis,
                        .y = axis,
                        .max_rate = share * consolidation_rate(batch.packing(k), pressure),
                        .max_steps = 2000000});
  }
  std::vector<kernels::RveReport> reports(batch.size());
  const kernels::EngineSettings settings{.precision = kernels::Precision::float64, .hold_tolerance = 1e-4};
  kernels::advance(batch, std::span<const kernels::ServoRequest>(requests), settings, reports);
  kernels::commit(batch);
  return reports;
}

/// States and measures of a consolidated batch.
void take_results(std::span<PackedRve> rves, const kernels::RveBatch& batch,
                  std::span<const kernels::RveReport> reports) {
  for (std::size_t k = 0; k < rves.size(); ++k) {
    PackedRve& rve = rves[k];
    load_rve(batch.committed, k, rve);
    rve.void_ratio = void_ratio(rve.cell.det(), rve.packing.solid_area());
    rve.pressure = reports[k].pressure();
    rve.coordination = 2.0 * reports[k].contacts / rve.packing.size();
    rve.unbalanced = reports[k].unbalanced;
    rve.status = reports[k].status;
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

/// Loose packings to rest: with each one's temporary friction, then with the working one at the same pressure.
std::vector<PackedRve> settle(std::span<const PackedRve> loose, const PackingCase& recipe) {
  std::vector<PackedRve> rves(loose.begin(), loose.end());
  kernels::RveBatch batch = batch_of(rves);
  for (std::size_t k = 0; k < rves.size(); ++k) {
    for (kernels::GrainMaterial& material : batch.packings[k].materials)
      material.friction = rves[k].consolidation_friction;
  }
  consolidate(batch, recipe.pressure, 1.0);
  for (std::size_t k = 0; k < rves.size(); ++k) batch.packings[k].materials = rves[k].packing.materials;
  const std::vector<kernels::RveReport> reports = consolidate(batch, recipe.pressure, 0.1);
  take_results(rves, batch, reports);
  return rves;
}

/// Each packing with the temporary friction that gives it the wanted void ratio, by bisection: more friction, looser
/// packing. The nearest packing seen is taken; one that misses by more than `void_ratio_tolerance` ends as step_limit.
std::vector<PackedRve> find_void_ratio(std::vector<PackedRve> loose, const PackingCase& recipe) {
  std::vector<double> low(loose.size(), 0.0), high(loose.size(), 1.0);
  std::vector<PackedRve> best;
  for (int round = 0; round < void_ratio_rounds; ++round) {
    for (std::size_t k = 0; k < loose.size(); ++k)
      loose[k].consolidation_friction = round == 0 ? 0.25 : 0.5 * (low[k] + high[k]);
    const std::vector<PackedRve> tried = settle(loose, recipe);
    if (best.empty()) best = tried;
    for (std::size_t k = 0; k < loose.size(); ++k) {
      const double miss = tried[k].void_ratio - recipe.void_ratio;
      (miss > 0 ? high : low)[k] = loose[k].consolidation_friction;
      if (std::abs(miss) < std::abs(best[k].void_ratio - recipe.void_ratio)) best[k] = tried[k];
    }
  }
  for (PackedRve& rve : best) {
    if (std::abs(rve.void_ratio - recipe.void_ratio) > void_ratio_tolerance)
      rve.status = kernels::RveStatus::step_limit;
  }
  return best;
}

}  // namespace

std::vector<kernels::GrainMaterial> grain_materials(const SoilCase& soil) {
  const auto material = [](const auto& from) {
    return kernels::GrainMaterial{.modulus = from.modulus,
                                  .stiffness_ratio = from.stiffness_ratio,
                                  .friction = std::tan(from.friction),
                                  .rolling_stiffness = from.rolling_stiffness,
                                  .rolling_limit = from.rolling_limit};
  };
  if (soil.classes.empty()) return {material(soil)};
  std::vector<kernels::GrainMaterial> out;
  for (const GrainClassCase& grains : soil.classes) out.push_back(material(grains));
  return out;
}

std::vector<std::uint8_t> classes_of(const SoilCase& soil, std::span<const double> radii) {
  std::vector<std::uint8_t> out;
  for (std::size_t i = 0; i < radii.size() && soil.classes.size() > 1; ++i) {
    std::size_t k = 0;
    while (k + 1 < soil.classes.size() && 2.0 * radii[i] > soil.classes[k].size_to) ++k;
    out.push_back(static_cast<std::uint8_t>(k));
  }
  return out;
}

kernels::Packing packing_of(const SoilCase& soil, std::vector<double> radii, double thickness) {
  return {.radii = radii,
          .materials = grain_materials(soil),
          .class_of = classes_of(soil, radii),
          .thickness = thickness,
          .local_damping = soil.damping};
}

double void_ratio(double cell_area, double solid_area) { return cell_area / solid_area - 1.0; }

std::vector<double> sample_radii(const SoilCase& soil, int grains, std::int64_t seed) {
  const GradingByNumber grading(soil);
  Uniform uniform(seed);
  std::vector<double> radii(static_cast<std::size_t>(grains));
  for (std::size_t k = 0; k < radii.size(); ++k) {
    radii[k] = 0.5 * grading.size_at((static_cast<double>(k) + uniform()) / grains);
  }
  std::sort(radii.rbegin(), radii.rend());
  return radii;
}

std::vector<PackedRve> make_packings(const SoilCase& soil, const PackingCase& recipe,
                                     std::span<const std::int64_t> seeds) {
  std::vector<PackedRve> loose(seeds.size());
  for (std::size_t k = 0; k < seeds.size(); ++k) {
    loose[k] = loose_packing(soil, recipe, seeds[k]);
    loose[k].consolidation_friction = recipe.consolidation_friction;
  }
  if (loose.empty()) return loose;
  return recipe.void_ratio > 0 ? find_void_ratio(loose, recipe) : settle(loose, recipe);
}

PackedRve settle_foreign_packing(const SoilCase& soil, const PackingCase& recipe) {
  PackedRve rve = grains_from(io::load_packing_csv(recipe.file), soil);
  kernels::RveBatch batch = batch_of(std::span(&rve, 1));
  const std::vector<kernels::RveReport> reports = consolidate(batch, recipe.pressure, 0.1);
  take_results(std::span(&rve, 1), batch, reports);
  return rve;
}

kernels::RveBatch batch_of(std::span<const PackedRve> rves) {
  std::vector<kernels::Packing> packings;
  std::vector<int> packing_of;
  for (const PackedRve& rve : rves) {
    packing_of.push_back(static_cast<int>(packings.size()));
    packings.push_back(rve.packing);
  }
  kernels::RveBatch batch = kernels::make_batch(std::move(packings), std::move(packing_of));
  for (std::size_t k = 0; k < rves.size(); ++k) store_rve(rves[k], batch, k);
  return batch;
}

std::string recipe_text(const SoilCase& soil, const PackingCase& recipe, std::int64_t seed) {
  std::string text = fmt::format("recipe {} d {} {} damping {} t {} grains {} mu_t {} p {} seed {}", recipe_version,
                                 soil.size_minimum, soil.size_maximum, soil.damping, soil.thickness, recipe.grains,
                                 recipe.consolidation_friction, recipe.pressure, seed);
  if (recipe.void_ratio > 0) text += fmt::format(" e {}", recipe.void_ratio);
  for (const kernels::GrainMaterial& m : grain_materials(soil)) {
    text += fmt::format(" E {} kt/kn {} mu {} beta {} eta {}", m.modulus, m.stiffness_ratio, m.friction,
                        m.rolling_stiffness, m.rolling_limit);
  }
  for (const GrainClassCase& grains : soil.classes) text += fmt::format(" to {}", grains.size_to);
  for (std::size_t k = 0; k < soil.sizes.size(); ++k) text += fmt::format(" {}:{}", soil.sizes[k], soil.passing[k]);
  return text + (soil.passing_by == GradingMeasure::area ? " by area" : " by number");
}

void store_rve(const PackedRve& from, kernels::RveBatch& batch, std::size_t rve) {
  kernels::RveStates& to = batch.committed;
  if (static_cast<int>(from.contact_key.size()) > to.contact_capacity()) {
    throw std::invalid_argument("a packing has more contacts than discs can have");
  }
  batch.candidates.skin[rve] = -1.0;
  std::copy(from.position.begin(), from.position.end(), &to.position(rve, 0, 0));
  std::copy(from.rotation.begin(), from.rotation.end(), &to.rotation(rve, 0));
  const double h[4] = {from.cell.xx, from.cell.xy, from.cell.yx, from.cell.yy};
  for (std::size_t k = 0; k < 4; ++k) to.cell(rve, k) = h[k];
  to.contact_count(rve) = static_cast<int>(from.contact_key.size());
  std::copy(from.contact_key.begin(), from.contact_key.end(), &to.contact_key(rve, 0));
  std::copy(from.contact_history.begin(), from.contact_history.end(), to.histories_of(rve));
}

void load_rve(const kernels::RveStates& from, std::size_t rve, PackedRve& to) {
  const std::size_t n = to.packing.radii.size();
  const auto contacts = static_cast<std::size_t>(from.contact_count(rve));
  to.position.assign(&from.position(rve, 0, 0), &from.position(rve, 0, 0) + 2 * n);
  to.rotation.assign(&from.rotation(rve, 0), &from.rotation(rve, 0) + n);
  to.cell = {from.cell(rve, 0), from.cell(rve, 1), from.cell(rve, 2), from.cell(rve, 3)};
  to.contact_key.assign(&from.contact_key(rve, 0), &from.contact_key(rve, 0) + contacts);
  to.contact_history.assign(from.histories_of(rve), from.histories_of(rve) + from.history_size() * contacts);
}

}  // namespace voussoir::host
