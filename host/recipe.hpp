#pragma once
/// Making one packing from a recipe (method.md §3): loose random discs, isotropic consolidation with the temporary friction,
/// then the working friction at the same pressure. Same recipe and seed: same packing, bit for bit.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "host/case.hpp"
#include "kernels/advance_rves.hpp"

namespace voussoir::host {

/// A packing with the state of its one RVE and what was measured on it.
struct PackedRve {
  kernels::Packing packing;
  std::vector<double> position;  ///< (grain, 2) [m]
  std::vector<double> rotation;  ///< (grain) [rad]
  kernels::Mat2 cell;            ///< columns are the periodic vectors [m]
  std::vector<std::uint32_t> contact_key;
  std::vector<double> contact_history;  ///< (contact, 2): tangential force [N], rolling moment [N m]
  std::int64_t seed = 0;
  double void_ratio = 0;    ///< area of voids / area of grains [-]
  double pressure = 0;      ///< [Pa]
  double coordination = 0;  ///< 2 contacts / grains [-]
  double unbalanced = 0;    ///< [-]
  double bias = 0;          ///< largest |tau_xy|/sigma_yy of the oedometric test above 20 kPa [-]; see packing.hpp
};

/// The grain material of a soil.
[[nodiscard]] kernels::GrainMaterial grain_material(const SoilCase& soil);

/// Radii [m] of `grains` discs, descending: uniform by number between the soil's sizes, stratified so that a small packing has the
/// same grading as a large one, in random order of placement.
[[nodiscard]] std::vector<double> sample_radii(const SoilCase& soil, int grains, std::int64_t seed);

/// The packings of several seeds, side by side in one batch. Throws std::runtime_error when one does not come to rest.
[[nodiscard]] std::vector<PackedRve> make_packings(const SoilCase& soil, const PackingCase& recipe,
                                                   std::span<const std::int64_t> seeds);

/// A batch of one RVE per packing, each in its packing's state.
[[nodiscard]] kernels::RveBatch batch_of(std::span<const PackedRve> rves);

/// Everything that decides the packing's numbers, as text; equal texts give equal packings.
[[nodiscard]] std::string recipe_text(const SoilCase& soil, const PackingCase& recipe, std::int64_t seed);

/// The RVE's state into / out of a batch.
void store_rve(const PackedRve& from, kernels::RveStates& to, std::size_t rve);
void load_rve(const kernels::RveStates& from, std::size_t rve, PackedRve& to);

/// 2 x 2 area of the cell over the area of its grains, less one.
[[nodiscard]] double void_ratio(double cell_area, double solid_area);

}  // namespace voussoir::host
