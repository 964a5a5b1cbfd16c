#pragma once
/// Stage "gravity": from the isotropic initial state to geostatic equilibrium on the fixed mesh.

#include "host/stages/ground_run.hpp"
#include "host/stages/k0_table.hpp"
#include "host/stages/stage.hpp"

namespace voussoir::host {

/// Goes on where the ground stands. The opening is held by the tractions of eqs. (15), (16).
[[nodiscard]] RunStatus settle_under_gravity(GroundRun& run, const GroundCase& soil, const GravityCase& gravity,
                                             const K0Table& k0);

}  // namespace voussoir::host
