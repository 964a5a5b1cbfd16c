#pragma once
/// Candidate contacts of one RVE: all pairs closer than r_i + r_j + skin in a periodic, possibly sheared cell.

#include <cstdint>
#include <span>
#include <vector>

#include "kernels/kinematics.hpp"

namespace voussoir::kernels {

/// Periodic cell with its inverse, for nearest images.
struct Cell {
  Mat2 h;        ///< columns are the periodic vectors [m]
  Mat2 inverse;

  explicit Cell(const Mat2& cell) : h(cell), inverse(cell.inverse()) {}

  /// The point's image inside the cell.
  void wrap(double& x, double& y) const;
  /// The nearest image of a difference vector, in the cell's own (sheared) metric: exact for lengths below half a height.
  void nearest(double& dx, double& dy) const;
  /// Distance between opposite sides: along fractional axis 0 and 1.
  [[nodiscard]] double height(int axis) const;
};

/// The same lattice with its shortest vectors (Gauss' reduction): a cell never gets thin by shear alone, so shear is unlimited.
[[nodiscard]] Mat2 reduced_lattice(Mat2 cell);

/// Nearest images are unique for contacts: both heights exceed two contact distances of the largest grains.
[[nodiscard]] bool wide_enough(const Cell& cell, double largest_radius, double skin);

/// Keys (kernels/rve_batch.hpp, pair_key) in ascending order into `keys`.
/// @param positions (grain, 2) in the cell [m]; @param radii (grain) [m]; @param skin [m]
void find_candidates(std::span<const double> positions, std::span<const double> radii, const Cell& cell, double skin,
                     std::vector<std::uint32_t>& keys);

}  // namespace voussoir::kernels
