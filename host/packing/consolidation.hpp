#pragma once
/// Isotropic consolidation: packings come to rest under a pressure, many side by side in one batch. What happens to one
/// of them does not depend on the others.

#include <span>
#include <vector>

#include "host/packing/packed_rve.hpp"

namespace voussoir::host {

/// Brings RVEs to rest at `pressure` [Pa] with the friction that their grains have, and takes over states, measures and
/// how it ended.
void rest_at(double pressure, std::span<PackedRve> rves);

/// Loose packings to rest at `pressure` [Pa]: with each one's temporary friction, then with the working one.
[[nodiscard]] std::vector<PackedRve> settle(std::span<const PackedRve> loose, double pressure);

/// Each packing with the temporary friction that gives it the wanted void ratio, by bisection: more friction, looser
/// packing. The nearest packing seen is taken; one that misses by more than 0.01 ends as step_limit.
[[nodiscard]] std::vector<PackedRve> settle_at_void_ratio(std::vector<PackedRve> loose, double pressure,
                                                          double void_ratio);

}  // namespace voussoir::host
