#pragma once
/// The periodic cell of an RVE as a lattice: its images, its shortest vectors, and its width.

#include <cmath>

#include "kernels/contact/kinematics.hpp"

namespace voussoir::kernels {

/// The nearest integer, the even one of two that are equally near, of a number below 2^51. std::nearbyint gives the
/// same, but calls a function where the processor is not known to have an instruction for it.
/// @tparam Number double, or lanes of doubles
template <class Number>
[[nodiscard]] KOKKOS_INLINE_FUNCTION Number nearest_integer(const Number& x) {
  const Number no_fraction(6755399441055744.0);  // 1.5 * 2^52: sums with it are rounded to integers
  return (x + no_fraction) - no_fraction;
}

/// Periodic cell with its inverse, for nearest images.
struct Cell {
  Mat2 h;  ///< columns are the periodic vectors [m]
  Mat2 inverse;

  KOKKOS_INLINE_FUNCTION explicit Cell(const Mat2& cell) : h(cell), inverse(cell.inverse()) {}

  /// Moves a point to its image inside the cell.
  KOKKOS_INLINE_FUNCTION void wrap(double& x, double& y) const {
    const double a = std::floor(inverse.xx * x + inverse.xy * y);
    const double b = std::floor(inverse.yx * x + inverse.yy * y);
    x -= h.xx * a + h.xy * b;
    y -= h.yx * a + h.yy * b;
  }

  /// Replaces a difference vector by its nearest image. The image is chosen in the cell's own (sheared) coordinates,
  /// which is exact for vectors shorter than half a height. @tparam Number double, or lanes of doubles
  template <class Number>
  KOKKOS_INLINE_FUNCTION void nearest(Number& dx, Number& dy) const {
    const Number a = nearest_integer(Number(inverse.xx) * dx + Number(inverse.xy) * dy);
    const Number b = nearest_integer(Number(inverse.yx) * dx + Number(inverse.yy) * dy);
    dx = dx - (Number(h.xx) * a + Number(h.xy) * b);
    dy = dy - (Number(h.yx) * a + Number(h.yy) * b);
  }

  /// Distance between the two opposite sides that bound the cell along fractional axis 0 or 1.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION double height(int axis) const {
    const double row = axis == 0 ? std::hypot(inverse.xx, inverse.xy) : std::hypot(inverse.yx, inverse.yy);
    return 1.0 / row;
  }
};

/// Whether the nearest image of a difference vector is shorter than `reach` [m].
[[nodiscard]] KOKKOS_INLINE_FUNCTION bool is_within(double reach, double dx, double dy, const Cell& cell) {
  cell.nearest(dx, dy);
  return dx * dx + dy * dy < reach * reach;
}

/// The same lattice, described by its shortest vectors (Gauss' reduction). Shear alone then never makes a cell thin, so
/// that shear is unlimited.
[[nodiscard]] KOKKOS_INLINE_FUNCTION Mat2 reduced_lattice(Mat2 cell) {
  constexpr int most_swaps = 1000;  // every swap but the last shortens a vector; the bound stops the loop for a cell
                                    // that holds a NaN
  for (int k = 0; k < most_swaps; ++k) {
    const double aa = cell.xx * cell.xx + cell.yx * cell.yx;
    const double bb = cell.xy * cell.xy + cell.yy * cell.yy;
    const double ab = cell.xx * cell.xy + cell.yx * cell.yy;
    if (aa <= bb) {
      const double n = std::nearbyint(ab / aa);
      if (n == 0 || !std::isfinite(n)) break;
      cell.xy -= n * cell.xx;
      cell.yy -= n * cell.yx;
    } else {
      const double n = std::nearbyint(ab / bb);
      if (n == 0 || !std::isfinite(n)) break;
      cell.xx -= n * cell.xy;
      cell.yx -= n * cell.yy;
    }
  }
  return cell;
}

/// Whether nearest images are unique for contacts: both heights must exceed two contact distances of the largest
/// grains.
[[nodiscard]] KOKKOS_INLINE_FUNCTION bool wide_enough(const Cell& cell, double largest_radius, double skin) {
  const double least = 2.0 * (2.0 * largest_radius + skin);
  return least < cell.height(0) && least < cell.height(1);
}

}  // namespace voussoir::kernels
