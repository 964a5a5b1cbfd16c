#pragma once
/// Candidate contacts of one RVE: all pairs closer than r_i + r_j + skin in a periodic, possibly sheared cell.

#include <cstdint>
#include <span>
#include <vector>

#include "kernels/contact/cell.hpp"

namespace voussoir::kernels::lanes {

/// Keys (state/rve_batch.hpp, pair_key) in ascending order into `keys`.
/// @param positions (grain, 2) in the cell [m]; @param radii (grain) [m]; @param skin [m]
void find_candidates(std::span<const double> positions, std::span<const double> radii, const Cell& cell, double skin,
                     std::vector<std::uint32_t>& keys);

}  // namespace voussoir::kernels::lanes
