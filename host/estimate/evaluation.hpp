#pragma once
/// The cost of an evaluation, and how many of them an increment takes.

#include "host/case/case.hpp"

namespace voussoir::host {

// Calibrated on the column `particle_steps` of run.h5. Relaxed increments (fem/relaxation.hpp) have later evaluations
// of few steps; the constants count evaluations of the full number of steps. With them the estimates are 0.95 of the
// work of cases/tunnel_quick, 1.25 of that of cases/tunnel_cps_d_cd3 and 1.6 of that of cases/biaxial_bvp (2026-11-26).
// Packings whose equilibrium is harder to find take up to 1.5 times as much.
inline constexpr double gravity_evaluations = 1.2;
inline constexpr double loss_evaluations = 4.5;
inline constexpr double gravity_strain = 0.014;  ///< mean strain of an RVE over the load factor's step
inline constexpr double loss_strain = 0.2;       ///< mean strain of an RVE over the volume loss of an increment

/// Steps to a strain, from the inertial number I = strain / steps * sqrt(m / (p t)).
[[nodiscard]] double inertial_steps(const SoilCase& soil, double strain, double pressure, double inertial_number);

/// Steps of one evaluation of one RVE.
[[nodiscard]] double steps_per_evaluation(const SoilCase& soil, const EngineCase& engine, double strain,
                                          double pressure);

}  // namespace voussoir::host
