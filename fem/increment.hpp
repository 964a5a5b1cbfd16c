#pragma once
/// One increment on its way to equilibrium: the load that it must carry, and the iterate that was found.

#include <vector>

#include "fem/boundary.hpp"
#include "fem/gauss_points.hpp"

namespace voussoir::fem {

/// What an increment is asked for.
struct IncrementLoad {
  Eigen::VectorXd external_force;   ///< at the end of the increment, n_dofs [N/m]
  Constraints prescribed;           ///< displacement increments [m]
  double predictor_ratio = 0;       ///< first iterate: ratio * last increment; 0: elastic from the committed state
  double reference_force = 0;       ///< see the convergence definition, e.g. the norm of a stage's final load [N/m]
  Eigen::VectorXd first_step = {};  ///< the first iterate, n_dofs [m]; empty: as predictor_ratio says
  double moved = 0;                 ///< norm of a displacement that Du is a further part of (relaxation.hpp) [m]
  int max_iterations = 0;           ///< 0: NewtonOptions::max_iterations
  bool keep_matrix = false;         ///< K stays that of the last call: no tangents are asked for
  double near_residual = 0;         ///< over the reference of the tolerance: ends the iterates as `near` [-]; 0: never
  bool settle = false;  ///< points at their step limit must not matter: unsettled_force within the tolerance, or not
                        ///< converged
  bool leave_best = false;  ///< max_iterations, near: the material's last evaluation is at the best iterate
};

/// The last iterate, or with IncrementLoad::leave_best the best one.
struct Increment {
  Eigen::VectorXd displacement;     ///< Du, n_dofs [m]
  std::vector<Gradient> gradients;  ///< F_rel - I, n_points [-]
  std::vector<Stress> stress;       ///< n_points [Pa]
  std::vector<Tangent> tangent;     ///< those of K, n_points; empty: of an increment that kept the matrix [Pa]
  Eigen::VectorXd external_force;   ///< n_dofs [N/m]
  Eigen::VectorXd reactions;  ///< f_int - f_ext at constrained dofs, zero elsewhere; of the support on the soil [N/m]
  Eigen::VectorXd residual;   ///< f_ext - f_int at free dofs, zero elsewhere, n_dofs [N/m]
  GaussPoints points;         ///< the geometry of the integration
  Eigen::VectorXd last_part;  ///< displacement since that geometry: Du, or the last substep's where it was relaxed [m]
};

}  // namespace voussoir::fem
