#pragma once
/// Candidate contacts of one RVE: all pairs closer than r_i + r_j + skin in a periodic, possibly sheared cell.

#include <cstdint>
#include <span>
#include <vector>

#include "kernels/contact/cell.hpp"

namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES {

/// Writes the keys of the candidates (pair_key in state/rve_batch.hpp) to `keys`, in ascending order.
/// @param positions (grain, 2) in the cell [m]; @param radii (grain) [m]; @param skin [m]
void find_candidates(std::span<const double> positions, std::span<const double> radii, const Cell& cell, double skin,
                     std::vector<std::uint32_t>& keys);

}  // namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES
