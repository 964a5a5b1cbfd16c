#pragma once
/// `engine.accuracy`: from an error of the stress to the settings of the grain engine, by measured curves.
///
/// The error is that of q/p along a path to 5 % of shear strain, root mean square over packings, with a margin for
/// other paths (docs/validation/trade.md, "Accuracy"). It follows the inertial number I. What I does at another
/// pressure, modulus or thickness depends on one number, the inertial time sqrt(m/(p t)) [steps]
/// (kernels/state/rve_batch.hpp), because this time is all that tells two scenes of equal grains apart.

#include "host/case/case.hpp"

namespace voussoir::host {

inline constexpr double finest_accuracy = 5e-4;  ///< [-]

/// What an RVE at one pressure gets.
struct AccuracyChoice {
  double inertial_number = 0;  ///< of an increment [-]
  double error = 0;            ///< expected, over the pressure [-]; above the accuracy where that cannot be met
};

/// The error to expect at an inertial number, which is taken to be within the measured ones, over the pressure [-].
/// @param inertial_time [steps]
[[nodiscard]] double expected_error(double inertial_number, double inertial_time);

/// The largest inertial number whose expected error is at most `accuracy` [-], or the smallest measured one where none
/// is so good. @param inertial_time [steps]
[[nodiscard]] AccuracyChoice choose_inertial_number(double accuracy, double inertial_time);

/// The inertial number of an engine for an RVE of this inertial time [steps].
[[nodiscard]] double inertial_number_at(double inertial_time, const EngineCase& engine);

/// The inertial time of a grain of the soil's mean radius and material, which classes of grains and grading curves
/// differ from, whose mass is the scaled one that the engine's law gives it [steps]. @param pressure [Pa]
[[nodiscard]] double inertial_time_of(const SoilCase& soil, double pressure);

/// Sets what an accuracy decides for all RVEs alike: the end of the hold and the bounds of the steps.
void apply_accuracy(EngineCase& engine);

/// One sentence for a log: the inertial numbers at some pressures, and where the accuracy cannot be met.
[[nodiscard]] std::string accuracy_note(const EngineCase& engine, const SoilCase& soil);

}  // namespace voussoir::host
