#pragma once
/// Nodal forces of stress errors that are independent from point to point. They are the noise of the grains, and
/// neither a residual nor a correction can be brought below it.

#include <vector>

#include "fem/gauss_points.hpp"

namespace voussoir::fem {

/// The norm of the residual that independent stress errors of `stress_noise` rms [Pa] at every Gauss point make:
/// |R|^2 = noise^2 * sum over points of volume^2 * sum over free dofs of |grad N|^2 [N/m].
[[nodiscard]] double noise_force(const Mesh& mesh, const GaussPoints& points, const std::vector<char>& constrained,
                                 double stress_noise);

/// Nodal forces f of one fixed draw of such errors, +-1 Pa each (zero at constrained dofs) [N/m]. |K^-1 f| estimates
/// the effect of the noise on a correction; its expectation would take one solution for every point.
[[nodiscard]] Eigen::VectorXd unit_noise_sample(const Mesh& mesh, const GaussPoints& points,
                                                const std::vector<char>& constrained);

}  // namespace voussoir::fem
