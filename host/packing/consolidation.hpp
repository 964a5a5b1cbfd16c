#pragma once
/// Isotropic consolidation: packings come to rest under a pressure, many side by side in one batch. The result of a
/// packing does not depend on the others.

#include <span>
#include <vector>

#include "host/packing/packed_rve.hpp"

namespace voussoir::host {

/// Brings RVEs to rest at `pressure` [Pa] with the friction that their grains have, and stores
/// states, measures and status in them.
void rest_at(double pressure, std::span<PackedRve> rves);

/// Brings loose packings to rest at `pressure` [Pa], first with the temporary friction of each and, unless
/// consolidation_rolling says otherwise, without rolling resistance; then with the materials of its grains.
[[nodiscard]] std::vector<PackedRve> settle(std::span<const PackedRve> loose, double pressure);

/// Finds for each packing the temporary friction that leads to the wanted void ratio, by bisection: more friction makes
/// a looser packing. The nearest packing of all tries is taken; if it is off by more than 0.01, its status is
/// step_limit.
[[nodiscard]] std::vector<PackedRve> settle_at_void_ratio(std::vector<PackedRve> loose, double pressure,
                                                          double void_ratio);

}  // namespace voussoir::host
