#include "host/packing/law_range.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernels/state/mobility.hpp"

namespace voussoir::host {

double least_void_ratio(double size_ratio) {
  const double r = 1.0 / std::max(size_ratio, 1.0);
  // A. Florian, "Ausfuellung der Ebene durch Kreise", Rend. Circ. Mat. Palermo 9 (1960): the density of the triangle
  // between two discs of radius r and one of radius 1 that touch one another.
  const double density = (std::numbers::pi * r * r + 2 * (1 - r * r) * std::asin(r / (1 + r))) /
                         (2 * r * std::sqrt(2 * r + 1));
  return 1 / density - 1;
}

double least_void_ratio(const kernels::Packing& packing) {
  const auto [smallest, largest] = std::minmax_element(packing.radii.begin(), packing.radii.end());
  return smallest == packing.radii.end() ? 0.0 : least_void_ratio(*largest / *smallest);
}

double stiffness_number(const kernels::Packing& packing, double pressure) {
  constexpr double limit = kernels::EngineSettings{}.overlap_limit;
  return kernels::mean_stiffness<kernels::PlainEngineLaw>(packing, limit) / (pressure * packing.thickness);
}

// The stress of Love and Weber makes the mean overlap pi / (Z phi kappa) for Z contacts a grain and the solid fraction
// phi; both grow with the square root of the compression beyond first contact, hence the second term.
double foretold_overlap(double kappa) { return 0.92 / (kappa + 1.6 * std::sqrt(kappa)); }

// Measured from 0.8 to 5 MPa: ln (1 + e) falls by 2.75 to 3.05 times the mean overlap. 2 would be overlap alone; the
// rest are contacts that overlap brings about.
double foretold_void_ratio(double loose, double mean_overlap) {
  return (1 + loose) * std::exp(-2.8 * mean_overlap) - 1;
}

std::string interpenetration(const PackedRve& rve) {
  const double least = least_void_ratio(rve.packing);
  if (rve.void_ratio >= least) return {};
  return fmt::format(
      "its void ratio of {:.4f} is below {:.4f}, that of the densest packing of rigid grains of its sizes: "
      "its grains interpenetrate, with a mean overlap of {:.1f} % of r_i + r_j at kappa = {:.3g}",
      rve.void_ratio, least, 100 * rve.mean_overlap, stiffness_number(rve.packing, rve.pressure));
}

}  // namespace voussoir::host
