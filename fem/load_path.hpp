#pragma once
/// The load of a stage as a function of its load parameter: what the load stepper and a relaxation walk along.

#include <functional>

#include "fem/boundary.hpp"

namespace voussoir::fem {

/// The load as a function of the parameter, given by the stage.
struct LoadPath {
  std::function<Eigen::VectorXd(double parameter)> external_force;          ///< n_dofs [N/m]
  std::function<Constraints(double from, double to)> prescribed_increment;  ///< [m]; always the same dofs
  double reference_force = 0;                                               ///< as IncrementLoad::reference_force
};

}  // namespace voussoir::fem
