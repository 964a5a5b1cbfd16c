#pragma once
/// Nodal forces of stress errors that are independent from point to point: the noise of grains, below which no residual
/// and no correction can be brought.

#include <vector>

#include "fem/gauss_points.hpp"

namespace voussoir::fem {

/// Force on the residual's norm of independent stress errors of `stress_noise` rms [Pa] at every Gauss point:
/// |R|^2 = noise^2 * sum over points of volume^2 * sum over free dofs of |grad N|^2 [N/m].
[[nodiscard]] double noise_force(const Mesh& mesh, const GaussPoints& points, const std::vector<char>& constrained,
                                 double stress_noise);

/// Nodal forces of one fixed draw of such errors, +-1 Pa each (zero at constrained dofs) [N/m]: |K^-1 f| estimates what
/// the noise does to a correction, which its expectation would cost one solution for every point to know.
[[nodiscard]] Eigen::VectorXd unit_noise_sample(const Mesh& mesh, const GaussPoints& points,
                                                const std::vector<char>& constrained);

}  // namespace voussoir::fem
