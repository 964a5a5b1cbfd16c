#pragma once
/// The load of a stage as a function of its load parameter, along which the load stepper and a relaxation walk.

#include <functional>

#include "fem/boundary.hpp"

namespace voussoir::fem {

/// The load as a function of the load parameter. The stage gives it.
struct LoadPath {
  std::function<Eigen::VectorXd(double parameter)> external_force;          ///< n_dofs [N/m]
  std::function<Constraints(double from, double to)> prescribed_increment;  ///< [m]; the same dofs in every increment
  double reference_force = 0;                                               ///< as IncrementLoad::reference_force [N/m]
};

}  // namespace voussoir::fem
