#pragma once
/// Stiffness and internal force of a mesh. The pattern of the matrix holds every degree of freedom. Constrained degrees
/// of freedom keep their rows as a scaled identity, so that one symbolic factorisation serves every stage of a mesh.

#include "fem/gauss_points.hpp"
#include "fem/sparse_solver.hpp"

namespace voussoir::fem {

/// K = sum over elements of integral B^T D B, eq. (5), refilled through a scatter map made once.
class StiffnessAssembler {
 public:
  explicit StiffnessAssembler(const Mesh& mesh);

  [[nodiscard]] const SparsePattern& pattern() const { return pattern_; }

  /// Entries of K for the tangents D [Pa] (n_points); `constrained[dof]` marks rows and columns replaced by the
  /// identity times the mean diagonal.
  [[nodiscard]] std::vector<double> assemble(const GaussPoints& points, const std::vector<Tangent>& tangents,
                                             const std::vector<char>& constrained) const;

 private:
  const Mesh& mesh_;
  SparsePattern pattern_;
  std::vector<std::array<int, 136>> scatter_;  ///< place in the matrix of each of an element's 16 * 17 / 2 lower
                                               ///< entries
};

struct InternalForce {
  Eigen::VectorXd force;      ///< integral B^T sigma, n_dofs [N/m]
  Eigen::VectorXd magnitude;  ///< sum over elements of |element force| by node, n_nodes [N/m]: the local scale of a
                              ///< residual
};

/// Internal force, eq. (6), of the stresses [Pa] (n_points).
[[nodiscard]] InternalForce internal_force(const Mesh& mesh, const GaussPoints& points,
                                           const std::vector<Stress>& stress);

}  // namespace voussoir::fem
