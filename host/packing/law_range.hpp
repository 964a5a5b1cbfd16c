#pragma once
/// How far the contact law can be trusted: it treats overlaps as small. docs/explanation/range.md has the measurements
/// behind the limits, and their sources.

#include <string>

#include "host/packing/packed_rve.hpp"

namespace voussoir::host {

/// The largest mean overlap over r_i + r_j of an RVE's contacts up to which stresses count as those of grains [-].
inline constexpr double most_mean_overlap = 0.06;

/// The overlap over r_i + r_j of a single contact beyond which a grain counts as crushed [-]: the point is reported as
/// out of range, and the run goes on, because in a wide grading one small grain between large ones says little of the
/// stress of thousands of contacts. A stored packing with such a contact is refused.
inline constexpr double most_single_overlap = 0.3;

/// The void ratio below which no plane packing of rigid discs can be, whatever its order [-]: Florian's bound
/// of the density for radii between two limits, which is the hexagonal packing's for equal discs.
/// @param size_ratio largest over smallest size, at least 1
[[nodiscard]] double least_void_ratio(double size_ratio);
[[nodiscard]] double least_void_ratio(const kernels::Packing& packing);

/// The stiffness number kappa = k_n / (p t) of a packing under a pressure [-]: mean normal stiffness of its grains over
/// the force per length that a pressure [Pa] puts on a thickness. Overlaps over diameters go as 1/kappa.
[[nodiscard]] double stiffness_number(const kernels::Packing& packing, double pressure);

/// The range of kappa at 100 kPa outside of which `check` warns [-]. Soils from 51 to 5060 were measured
/// (docs/validation/trade.md: 0.3, 3 and 30 GPa at a thickness of 0.1 m), and the one with 51 had little more than half
/// the strength of the others.
inline constexpr double least_usual_stiffness = 60, most_usual_stiffness = 6000;

/// The mean overlap over r_i + r_j of a packing at rest under isotropic pressure [-], to 20 %
/// (docs/explanation/range.md).
[[nodiscard]] double foretold_overlap(double kappa);

/// The mean overlap in a test of strength, over that of an isotropic packing at the same mean stress [-]: sheared
/// packings carry it with fewer contacts. 1.4 to 1.7 was measured.
inline constexpr double overlap_of_shear = 1.5;

/// The void ratio that isotropic compression leaves of one at little pressure, from the mean overlap [-].
[[nodiscard]] double foretold_void_ratio(double loose, double mean_overlap);

/// A sentence that says that the grains interpenetrate, because the void ratio is below that of the densest packing of
/// rigid grains; empty where they do not.
[[nodiscard]] std::string interpenetration(const PackedRve& rve);

}  // namespace voussoir::host
