#pragma once
/// Takes the ground through one stage. Each load increment is brought to equilibrium, recorded and kept in a
/// checkpoint.

#include "fem/newton.hpp"
#include "host/stages/ground_run.hpp"
#include "host/stages/stage.hpp"

namespace voussoir::host {

/// Starts at the load parameter that the ground has reached and goes through the targets beyond this value. A numerical
/// failure is returned as a status and explained in the log; an increment that did not converge is not recorded.
[[nodiscard]] RunStatus advance_stage(GroundRun& run, const Stage& stage);

[[nodiscard]] fem::NewtonOptions newton_options(const NewtonCase& newton);

}  // namespace voussoir::host
