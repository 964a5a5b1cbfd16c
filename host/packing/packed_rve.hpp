#pragma once
/// A packing with the state of its one RVE, and how the state enters a batch and leaves it.

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "host/case/case.hpp"
#include "kernels/state/rve_batch.hpp"

namespace voussoir::host {

/// A packing with the state of its one RVE and the values measured on this RVE.
struct PackedRve {
  kernels::Packing packing;
  std::vector<double> position;  ///< (grain, 2) [m]
  std::vector<double> rotation;  ///< (grain) [rad]
  kernels::Mat2 cell;            ///< columns are the periodic vectors [m]
  std::vector<std::uint32_t> contact_key;
  std::vector<double> contact_history;  ///< (contact, k), k as in the law's history_names [SI]
  std::int64_t seed = 0;
  double consolidation_friction = 0;   ///< temporary friction coefficient of its consolidation [-]
  bool consolidation_rolling = false;  ///< grains resisted rolling during consolidation, too
  double void_ratio = 0;               ///< area of voids / area of grains [-]
  double pressure = 0;                 ///< [Pa]
  double coordination = 0;             ///< 2 contacts / grains [-]
  double unbalanced = 0;               ///< [-]
  double mean_overlap = 0;             ///< mean over the contacts of overlap / (r_i + r_j) [-]; 0 where it is not known
  double bias = std::numeric_limits<double>::quiet_NaN();     ///< see bias.hpp [-]; NaN: not measured
  kernels::RveStatus status = kernels::RveStatus::converged;  ///< of the consolidation
};

/// The materials of a soil's classes, and the class of each grain (empty for a soil of one class).
[[nodiscard]] std::vector<kernels::GrainMaterial> grain_materials(const SoilCase& soil);
[[nodiscard]] std::vector<std::uint8_t> classes_of(const SoilCase& soil, std::span<const double> radii);

/// The packing of grains of these radii [m], made of this soil.
[[nodiscard]] kernels::Packing packing_of(const SoilCase& soil, std::vector<double> radii, double thickness);

/// A batch of one RVE per packing, each in its packing's state.
[[nodiscard]] kernels::RveBatch batch_of(std::span<const PackedRve> rves);

/// Copy a state into the committed states of a batch, and out of them. store_rve throws std::invalid_argument if the
/// RVE has more contacts than the batch has room for.
void store_rve(const PackedRve& from, kernels::RveBatch& batch, std::size_t rve);
void load_rve(const kernels::RveStates& from, std::size_t rve, PackedRve& to);

/// Area of the cell over the area of its grains, less one.
[[nodiscard]] double void_ratio(double cell_area, double solid_area);

}  // namespace voussoir::host
