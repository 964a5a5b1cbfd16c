#pragma once
/// Constants of a packing under given settings and a given law.

#include "kernels/contact/pair_state.hpp"
#include "kernels/state/mobility.hpp"

namespace voussoir::kernels {

/// The constants that every look at an RVE needs.
struct RunScales {
  int grains = 0;
  double mean_diameter = 0;   ///< [m]
  double largest_radius = 0;  ///< [m]
  double mean_mobility = 0;   ///< [m/N]
  double mean_stiffness = 0;  ///< of the grains, each against an equal one, at the overlap limit [N/m]
  double thickness = 0;       ///< [m]
  double local_damping = 0;   ///< [-]
  double skin = 0;            ///< of the lists [m]
  double reach = 0;           ///< of the longest listed branch, 2 r_max + skin [m]
};

template <class Law>
[[nodiscard]] RunScales scales_of(const Packing& packing, const EngineSettings& settings) {
  const double diameter = packing.mean_diameter(), largest = packing.largest_radius();
  const double skin = settings.skin * diameter;
  return {.grains = packing.size(),
          .mean_diameter = diameter,
          .largest_radius = largest,
          .mean_mobility = mean_mobility<Law>(packing, settings.overlap_limit),
          .mean_stiffness = mean_stiffness<Law>(packing, settings.overlap_limit),
          .thickness = packing.thickness,
          .local_damping = packing.local_damping,
          .skin = skin,
          .reach = 2.0 * largest + skin};
}

/// A grain's constants for the sweep. @param largest_radius of the packing [m]; @param overlap_limit of the settings
template <class Law>
[[nodiscard]] GrainShape<real_of<typename Law::Value>> grain_shape(const Packing& packing, std::size_t grain,
                                                                   double largest_radius, double overlap_limit) {
  using real = real_of<typename Law::Value>;
  const double r = packing.radii[grain];
  const Mobility mobility = mobility_of<Law>(packing.material_of(grain), r, largest_radius, overlap_limit);
  const auto a = static_cast<real>(mobility.translation);
  const auto a_r = static_cast<real>(mobility.rotation);
  return {static_cast<real>(r), a, a_r, real(0.5) * a, real(0.5) * a_r};
}

}  // namespace voussoir::kernels
