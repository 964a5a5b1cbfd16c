#pragma once
/// How far a packing is from isotropic: oedometric compression, which an isotropic packing answers without shear
/// stress.

#include <span>
#include <vector>

#include "host/packing/packed_rve.hpp"

namespace voussoir::host {

/// The bias of each packing [-]: the largest |tau_xy|/sigma_yy above 20 kPa while it is compressed along y from its own
/// pressure, without lateral strain, until sigma_yy has reached 700 kPa; the test of a packing ends early where an
/// increment fails.
[[nodiscard]] std::vector<double> biases_of(std::span<const PackedRve> rves);

}  // namespace voussoir::host
