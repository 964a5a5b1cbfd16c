#pragma once
/// Small packings for tests, all by the oracle alone.

#include <cstdint>

#include "tests/reference/reference_rve.hpp"

namespace voussoir::reference {

/// Grains 0 and 1 of radii `radius_i`, `radius_j` [m], touching with `overlap` [m] along the direction `angle` [rad]
/// from 0 to 1, alone in a square cell `cell_size` [m] wide.
Rve two_grains(double radius_i, double radius_j, double overlap, double angle, double cell_size,
               const Material& material);

/// Triangular lattice of equal discs, `columns` along x by `rows` (even) along y, neighbours overlapping by `overlap`
/// [m].
/// @throws std::invalid_argument when rows is odd or the cell is too small for nearest images
Rve hexagonal_packing(int columns, int rows, double radius, double overlap, const Material& material);

/// Discs with radii uniform by number on [radius_min, radius_max] [m], at rest, without contact. The same seed gives
/// the same grains with every compiler.
Rve loose_packing(int grain_count, double radius_min, double radius_max, std::uint64_t seed, const Material& material);

/// Compresses isotropically to `pressure` [Pa] within `tolerance` (relative) and holds.
/// @throws std::runtime_error when that is not reached
void compress_to(Rve& rve, double pressure, double tolerance = 1e-3);

/// Sets the friction coefficient and finds equilibrium again at constant volume, F = I.
void switch_friction(Rve& rve, double friction, int hold_steps = 2000);

/// loose_packing, compressed at `consolidation_friction`, then with the material's own: a dense packing in < 1 s for <
/// 60 grains.
Rve consolidated_packing(int grain_count, std::uint64_t seed, double pressure, double consolidation_friction,
                         const Material& material);

}  // namespace voussoir::reference
