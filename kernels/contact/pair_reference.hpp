#pragma once
/// The numbers of a listed pair that are computed from positions in double: the reference of its displacement form, and
/// its constants.

#include "kernels/contact/cell.hpp"
#include "kernels/contact/pair_state.hpp"

namespace voussoir::kernels {

/// Branch b0 and gap g0 = |b0|^2 - R^2 at a rebase, in double; the caller rounds them once.
struct PairReference {
  double branch_x, branch_y, gap;
};

/// The reference of a pair. @param dx, dy x_j - x_i for any image of j [m]; @param sum_radii R [m]
[[nodiscard]] KOKKOS_INLINE_FUNCTION PairReference pair_reference(double dx, double dy, double sum_radii,
                                                                  const Cell& cell) {
  cell.nearest(dx, dy);
  return {dx, dy, dx * dx + dy * dy - sum_radii * sum_radii};
}

/// Constants of a pair i < j, combined in the precision of the numbers given and rounded once. @param ri, rj radii [m]
template <class Law, class Number>
[[nodiscard]] KOKKOS_INLINE_FUNCTION PairShape<Law> pair_shape(int j, const GrainMaterialOf<Number>& of_i, Number ri,
                                                               const GrainMaterialOf<Number>& of_j, Number rj) {
  const auto r = [](Number x) { return static_cast<real_of<typename Law::Value>>(x); };
  const Number one(1), half(0.5);
  return {.other = j,
          .other_bytes = 0,
          .active = 1,
          .inverse_sum = r(one / (ri + rj)),
          .minus_inverse_sum_squared = r(-one / ((ri + rj) * (ri + rj))),
          .minus_half_sum = r(-half * (ri + rj)),
          .radius_other = r(rj),
          .law = Law::combine(of_i, ri, of_j, rj)};
}

}  // namespace voussoir::kernels
