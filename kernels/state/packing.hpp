#pragma once
/// A packing: what all RVEs cloned from it share.

#include <Kokkos_Macros.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/contact/engine_law.hpp"

namespace voussoir::kernels {

/// The data that all RVEs cloned from one packing share.
struct Packing {
  std::vector<double> radii;                                             ///< [m]
  std::vector<GrainMaterial> materials = std::vector<GrainMaterial>(1);  ///< the classes of grains (Table 1)
  std::vector<std::uint8_t> class_of;  ///< by grain, index into `materials`; empty: all of class 0
  double thickness = 0.1;              ///< out of plane [m]
  double local_damping = 0.3;          ///< Cundall's lambda [-]

  [[nodiscard]] int size() const { return static_cast<int>(radii.size()); }
  [[nodiscard]] const GrainMaterial& material_of(std::size_t grain) const {
    return class_of.empty() ? materials[0] : materials[class_of[grain]];
  }
  [[nodiscard]] double mean_diameter() const;
  [[nodiscard]] double largest_radius() const;
  [[nodiscard]] double solid_area() const;  ///< sum of pi r^2 [m^2]

  /// The function inertial_time below, with the mean mobility that the engine's law gives this packing at the default
  /// overlap limit.
  [[nodiscard]] double inertial_time(double pressure) const;
};

/// The inertial number divided by the strain rate, sqrt(m / (p t)) with the mean scaled mass [steps]: I = |D| *
/// inertial_time(p) for |D| in strain per step. @param mean_mobility [m/N]; @param thickness [m]; @param pressure [Pa]
[[nodiscard]] KOKKOS_INLINE_FUNCTION double inertial_time(double mean_mobility, double thickness, double pressure) {
  return 1.0 / std::sqrt(mean_mobility * pressure * thickness);
}

/// Whether any grain resists rolling; where none does, an engine runs from which that part of the law is compiled out.
[[nodiscard]] bool rolls(std::span<const Packing> packings);

}  // namespace voussoir::kernels
