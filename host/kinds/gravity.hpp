#pragma once
/// Stage "gravity" takes the ground from its isotropic initial state to geostatic equilibrium, on a fixed mesh.

#include "host/scene/k0_table.hpp"
#include "host/stages/ground_run.hpp"
#include "host/stages/stage.hpp"

namespace voussoir::host {

/// Goes on from the load factor that the ground has reached. The tractions of eqs. (15), (16) hold the opening.
[[nodiscard]] RunStatus settle_under_gravity(GroundRun& run, const GroundCase& soil, const GravityCase& gravity,
                                             const K0Table& k0);

}  // namespace voussoir::host
