#pragma once
/// One increment on its way to equilibrium: the load that it must carry, and the iterate that was found.

#include <vector>

#include "fem/boundary.hpp"
#include "fem/gauss_points.hpp"

namespace voussoir::fem {

/// The load that an increment has to carry, and how it is to be looked for.
struct IncrementLoad {
  Eigen::VectorXd external_force;  ///< at the end of the increment, n_dofs [N/m]
  Constraints prescribed;          ///< displacement increments [m]
  /// The first iterate is this ratio times the last increment; with 0 it is the elastic answer from the committed
  /// state.
  double predictor_ratio = 0;
  double reference_force = 0;       ///< for the tolerance (newton.hpp), e.g. the norm of a stage's final load [N/m]
  Eigen::VectorXd first_step = {};  ///< the first iterate, n_dofs [m]; where it is empty, predictor_ratio decides
  double moved = 0;  ///< norm of the displacement that Du continues, for substeps of a relaxation (relaxation.hpp) [m]
  int max_iterations = 0;    ///< 0 stands for NewtonOptions::max_iterations
  bool keep_matrix = false;  ///< K stays that of the last call, and no tangents are asked for
  /// Residual, over the reference of the tolerance, at which the iterates end with the status `near`; 0: never [-].
  double near_residual = 0;
  /// The increment has converged only if NewtonReport::unsettled_force is within the tolerance as well, so that points
  /// at their step limit do not matter.
  bool settle = false;
  /// Where the iterates end as `max_iterations` or `near`, the material's last evaluation is at the best iterate.
  bool leave_best = false;
};

/// The last iterate of an increment, or its best one where IncrementLoad::leave_best asks for that.
struct Increment {
  Eigen::VectorXd displacement;     ///< Du, n_dofs [m]
  std::vector<Gradient> gradients;  ///< F_rel - I, n_points [-]
  std::vector<Stress> stress;       ///< n_points [Pa]
  std::vector<Tangent> tangent;     ///< from which K was made, n_points [Pa]; empty where the matrix was kept
  Eigen::VectorXd external_force;   ///< n_dofs [N/m]
  Eigen::VectorXd reactions;  ///< f_int - f_ext at constrained dofs, zero elsewhere; of the support on the soil [N/m]
  Eigen::VectorXd residual;   ///< f_ext - f_int at free dofs, zero elsewhere, n_dofs [N/m]
  GaussPoints points;         ///< the geometry of the integration
  Eigen::VectorXd last_part;  ///< displacement since that geometry: Du, or the displacement of a relaxation's last
                              ///< substep [m]
};

}  // namespace voussoir::fem
