#pragma once
/// The test that measures how far a packing is from isotropic: oedometric compression, in which an isotropic packing
/// has no shear stress.

#include <span>
#include <vector>

#include "host/packing/packed_rve.hpp"

namespace voussoir::host {

/// The bias of each packing [-]. A packing is compressed along y without lateral strain, from its own pressure until
/// sigma_yy has reached 700 kPa. The bias is the largest |tau_xy|/sigma_yy where sigma_yy is above 20 kPa. The test of
/// a packing ends early where an increment fails.
[[nodiscard]] std::vector<double> biases_of(std::span<const PackedRve> rves);

}  // namespace voussoir::host
