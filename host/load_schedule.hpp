#pragma once
/// The planned load increments of the gravity stages (method.md, section 4).

#include "host/case.hpp"

namespace voussoir::host {

/// Load factors lambda in [0, 1] of a ground that starts at `initial_stress` and ends with `initial_stress + base_weight`
/// at its base: the base stress grows by `ratio` per increment until that is a step of `uniform_step`, then the steps
/// are uniform. Memoryless, so that a cut or resumed run goes on from any lambda.
class LoadSchedule {
 public:
  /// Stresses in [Pa], compression positive; base_weight is unit weight times height.
  LoadSchedule(const GravityCase& gravity, double initial_stress, double base_weight);

  /// The load factor planned after `lambda`; 1 at the end.
  [[nodiscard]] double next(double lambda) const;

  /// Increments from 0 to 1 when none is cut.
  [[nodiscard]] int count() const;

 private:
  double growth_;          ///< ratio - 1
  double initial_factor_;  ///< initial stress over base weight
  double uniform_step_;
};

}  // namespace voussoir::host
