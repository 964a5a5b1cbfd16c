#pragma once
/// An estimate of the work of a scene.

#include <vector>

#include "host/case/case.hpp"
#include "host/estimate/case_size.hpp"

namespace voussoir::host {

/// Points, regions, increments and work of a scene. The mesh is made for it; throws
/// what planned_scene throws.
[[nodiscard]] CaseSize scene_size(const Case& input);

/// The share of the lanes that hold an RVE: sum(n_k) / sum(ceil(n_k / width) width) for n_k points of packing k, since
/// the RVEs of a group are of one packing. 1 without grains. @param width lanes of a group
[[nodiscard]] double share_of_lanes(const std::vector<RegionSize>& regions, int width);

}  // namespace voussoir::host
