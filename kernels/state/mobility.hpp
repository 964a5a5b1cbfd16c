#pragma once
/// Scaled masses: the inertia that a grain needs so that one step is stable for all sizes
/// (docs/explanation/engine.md, "Time step and mass"). The law says how stiff a grain can be.

#include "kernels/state/rve_batch.hpp"

namespace voussoir::kernels {

inline constexpr double step_safety = 0.9;         ///< c of docs/explanation/engine.md
inline constexpr double assumed_neighbours = 6.0;  ///< contacts of one grain, for the bound on its stiffness

/// Inverse mass or moment of inertia for which a step of 1 is stable under a row sum of stiffnesses. It
/// is 0 for a row sum of 0, so that a motion which nothing resists does not take place.
[[nodiscard]] inline double mobility_under(double row_sum) {
  return row_sum > 0 ? step_safety * step_safety * 4.0 / row_sum : 0.0;
}

struct Mobility {
  double translation;  ///< dt^2/m [m/N]
  double rotation;     ///< dt^2/J [rad/(N m)]
};

/// The mobilities of a grain. @param largest_radius of the packing [m]; @param overlap_limit overlap/(r_i + r_j) at
/// which an RVE is given up
template <class Law>
[[nodiscard]] Mobility mobility_of(const GrainMaterial& material, double radius, double largest_radius,
                                   double overlap_limit) {
  const StableRows rows = Law::stable_rows(material, radius, largest_radius, assumed_neighbours, overlap_limit);
  return {mobility_under(rows.translation), mobility_under(rows.rotation)};
}

/// Mean of dt^2/m over a packing's grains [m/N].
template <class Law>
[[nodiscard]] double mean_mobility(const Packing& packing, double overlap_limit) {
  const double largest = packing.largest_radius();
  double sum = 0;
  for (std::size_t i = 0; i < packing.radii.size(); ++i) {
    sum += mobility_of<Law>(packing.material_of(i), packing.radii[i], largest, overlap_limit).translation;
  }
  return sum / static_cast<double>(packing.radii.size());
}

/// Mean normal stiffness of a packing's grains, each against an equal one, at the overlap limit [N/m].
template <class Law>
[[nodiscard]] double mean_stiffness(const Packing& packing, double overlap_limit) {
  double sum = 0;
  for (std::size_t i = 0; i < packing.radii.size(); ++i) {
    sum += Law::normal_stiffness_of(packing.material_of(i), packing.radii[i], overlap_limit);
  }
  return sum / static_cast<double>(packing.radii.size());
}

}  // namespace voussoir::kernels
