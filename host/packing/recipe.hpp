#pragma once
/// Making one packing from a recipe (method.md §3): loose random discs, isotropic consolidation with the temporary
/// friction, then the working friction at the same pressure. Same recipe and seed: same packing, bit for bit.

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "host/case/case.hpp"
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
  double consolidation_friction = 0;                          ///< temporary friction coefficient that made it [-]
  double void_ratio = 0;                                      ///< area of voids / area of grains [-]
  double pressure = 0;                                        ///< [Pa]
  double coordination = 0;                                    ///< 2 contacts / grains [-]
  double unbalanced = 0;                                      ///< [-]
  double bias = std::numeric_limits<double>::quiet_NaN();     ///< see packing.hpp [-]; NaN: not measured
  kernels::RveStatus status = kernels::RveStatus::converged;  ///< of the consolidation
};

/// The materials of a soil's classes, and the class of each grain (empty for a soil of one class).
[[nodiscard]] std::vector<kernels::GrainMaterial> grain_materials(const SoilCase& soil);
[[nodiscard]] std::vector<std::uint8_t> classes_of(const SoilCase& soil, std::span<const double> radii);

/// Radii [m] of `grains` discs, descending, from the soil's grading curve (linear in size between its points),
/// stratified: a small packing has the same grading as a large one.
[[nodiscard]] std::vector<double> sample_radii(const SoilCase& soil, int grains, std::int64_t seed);

/// What a packing of these radii [m] is made of.
[[nodiscard]] kernels::Packing packing_of(const SoilCase& soil, std::vector<double> radii, double thickness);

/// The packings of several seeds, side by side in one batch; each is the same whatever other seeds it is made with. One
/// that does not come to rest says so in its status.
[[nodiscard]] std::vector<PackedRve> make_packings(const SoilCase& soil, const PackingCase& recipe,
                                                   std::span<const std::int64_t> seeds);

/// The packing of another code (`recipe.file`, see io::load_packing_csv) with this soil's grains: contacts are rebuilt
/// from the overlaps, without history, then it comes to rest at `recipe.pressure`. Throws std::runtime_error on an
/// unusable file.
[[nodiscard]] PackedRve settle_foreign_packing(const SoilCase& soil, const PackingCase& recipe);

/// A batch of one RVE per packing, each in its packing's state.
[[nodiscard]] kernels::RveBatch batch_of(std::span<const PackedRve> rves);

/// Everything that decides the packing's numbers, as text; equal texts give equal packings.
[[nodiscard]] std::string recipe_text(const SoilCase& soil, const PackingCase& recipe, std::int64_t seed);

/// The RVE's state into a batch's committed states (throws std::invalid_argument if it has too many contacts), and out.
void store_rve(const PackedRve& from, kernels::RveBatch& batch, std::size_t rve);
void load_rve(const kernels::RveStates& from, std::size_t rve, PackedRve& to);

/// Area of the cell over the area of its grains, less one.
[[nodiscard]] double void_ratio(double cell_area, double solid_area);

}  // namespace voussoir::host
