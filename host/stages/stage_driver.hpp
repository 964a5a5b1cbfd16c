#pragma once
/// Takes the ground through one stage: load increments to equilibrium, each of them recorded and checkpointed.

#include "fem/newton.hpp"
#include "host/stages/ground_run.hpp"
#include "host/stages/stage.hpp"

namespace voussoir::host {

/// Goes from the load parameter that the ground has reached through the targets beyond it. Numerical failure is a
/// status; the log explains it, and nothing that did not converge is recorded.
[[nodiscard]] RunStatus advance_stage(GroundRun& run, const Stage& stage);

[[nodiscard]] fem::NewtonOptions newton_options(const NewtonCase& newton);

}  // namespace voussoir::host
