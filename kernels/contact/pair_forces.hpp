#pragma once
/// One pair: its distances, the law's forces, and the action on both grains; docs/explanation/contact_law.md.

#include "kernels/contact/contact_law.hpp"
#include "kernels/contact/pair_state.hpp"

namespace voussoir::kernels {

/// Distances of a pair, with y = R/|b|. In lanes where the pair does not touch they are 0, 0 and 1/R.
template <class V>
struct PairDistance {
  V overlap;         ///< q = delta/R = 1 - 1/y [-]
  V excess;          ///< z = y - 1 = delta/|b| [-]
  V inverse_length;  ///< y/R = 1/|b| [1/m]
};

/// z/e as a polynomial in e, where z = (1 - e)^(-1/2) - 1. The leading terms are exact, the others are fitted over 0 ..
/// 0.51. The relative error grows with e: up to an overlap of 1, 10, 20 and 30 % it is 3e-10, 9e-7, 5e-6 and 1.2e-5 in
/// float, 5e-15, 5e-9, 2e-7 and 1.4e-6 in double. Beyond 30 % an RVE is given up. The errors of q, y and 1/|b| are
/// smaller.
template <class V>
KOKKOS_FORCEINLINE_FUNCTION V excess_over(const V& e, const V& e2) {
  using real = real_of<V>;
  const auto c = [](double x) { return V(static_cast<real>(x)); };
  const V e4 = e2 * e2;
  const V p0 = fused(c(0.375), e, c(0.5));
  if constexpr (sizeof(real) == sizeof(float)) {
    const V p2 = fused(c(0.273604941), e, c(0.312499764));
    const V p4 = fused(c(0.338042773), e, c(0.236938801));
    const V p6 = fused(c(0.97745921), e, c(-0.282095656));
    return fused(fused(p6, e2, p4), e4, fused(p2, e2, p0));
  } else {
    const V p2 = fused(c(0.2734375), e, c(0.3125));
    const V p4 = fused(c(0.2255849802289785), e, c(0.246093750790672));
    const V p6 = fused(c(0.1864639065391075), e, c(0.209713862168221));
    const V p8 = fused(c(0.8810090424314304), e2, fused(c(-0.2865442362287911), e, c(0.2963936109142559)));
    return fused(fused(p8, e2, p6), e4 * e2, fused(fused(p4, e2, p2), e2, p0));
  }
}

/// Computes e = -g/R^2, then z, then q = z/y = e - (1 - e) z. About half of e is left after this subtraction, so it
/// loses no digits.
/// @tparam Shape PairShape, or its numbers pair by pair (lanes/spread_rve.hpp)
template <class Shape, class V>
KOKKOS_FORCEINLINE_FUNCTION PairDistance<V> distance_of(const V& gap, const Shape& shape) {
  const auto touches = gap < V(0);
  const V e = gap * V(shape.minus_inverse_sum_squared);
  const V z = Kokkos::Experimental::condition(touches, e * excess_over(e, e * e), V(0));
  const V q = Kokkos::Experimental::condition(touches, fused(e - V(1), z, e), V(0));
  return {q, z, fused(z, V(shape.inverse_sum), V(shape.inverse_sum))};
}

/// The force of one pair on grain i, and its torques on both grains.
template <class V>
struct PairAction {
  V force_x, force_y, torque_i, torque_j;
};

/// Current branch and squared gap of a pair.
template <class V>
struct PairGeometry {
  V branch_x, branch_y, gap;
};

template <class Law, class V>
KOKKOS_FORCEINLINE_FUNCTION PairGeometry<V> geometry_of(const PairLanes<Law>& pair, const CellMotion<V>& cell,
                                                        const V& du_x, const V& du_y) {
  const V dx = fused(cell.f_xx, pair.branch_x, fused(cell.f_xy, pair.branch_y, du_x));
  const V dy = fused(cell.f_yx, pair.branch_x, fused(cell.f_yy, pair.branch_y, du_y));
  const V two(2);
  return {pair.branch_x + dx, pair.branch_y + dy,
          fused(dx, fused(two, pair.branch_x, dx), fused(dy, fused(two, pair.branch_y, dy), pair.gap))};
}

/// e = -g/R^2 of a pair; 0 in lanes where the pair does not touch.
template <class Shape, class V>
KOKKOS_FORCEINLINE_FUNCTION V overlap_measure(const PairGeometry<V>& at, const Shape& shape) {
  return Kokkos::Experimental::condition(at.gap < V(0), at.gap * V(shape.minus_inverse_sum_squared), V(0));
}

/// The numbers of a grain that its pairs need for rotations.
template <class V>
struct GrainRim {
  V radius;  ///< [m]
  V spin;    ///< [rad/step]
  V rolled;  ///< radius * spin, the velocity of its rim [m/step]
};

template <class V>
KOKKOS_FORCEINLINE_FUNCTION GrainRim<V> rim_of(const V& radius, const V& spin) {
  return {radius, spin, radius * spin};
}

/// Applies the law to a pair that touches in at least one lane, and returns what the pair does to its grains. (dw_x,
/// dw_y) is w_j - w_i. The branch is not made a unit vector, because n and t are needed only in products that can be
/// divided by |b| afterwards. D_xx b is subtracted from D b, which changes nothing, since b has no part along t.
template <class Law, class Shape, class V>
KOKKOS_FORCEINLINE_FUNCTION PairAction<V> act(PairLanes<Law>& pair, const Shape& shape, const PairGeometry<V>& at,
                                              const CellMotion<V>& cell, const V& dw_x, const V& dw_y,
                                              const GrainRim<V>& i, const V& spin_j) {
  const PairDistance<V> distance = distance_of(at.gap, shape);
  const V vx = fused(cell.d_xy, at.branch_y, dw_x);
  const V vy = fused(cell.d_xy, at.branch_x, fused(cell.d_difference, at.branch_y, dw_y));
  const V across = fused(vy, at.branch_x, -(vx * at.branch_y));
  const V to_sliding = fused(distance.excess, distance.inverse_length, distance.inverse_length);  // y/|b|
  const V radius_j = V(shape.radius_other);
  const V sliding = fused(to_sliding, across, -fused(radius_j, spin_j, i.rolled));

  typename Law::History history = pair.history;
  const ContactForce<V> f = Law(shape.law)({distance.overlap, distance.excess, sliding, spin_j - i.spin}, history);
  Law::keep(history, pair.history);

  const V minus_half_sum(shape.minus_half_sum);
  const V arm_i = fused(minus_half_sum, distance.overlap, i.radius);
  const V arm_j = fused(minus_half_sum, distance.overlap, radius_j);
  const V along = f.normal_to_branch;
  const V aside = f.tangential * distance.inverse_length;
  PairAction<V> action{-fused(aside, at.branch_y, along * at.branch_x),
                       fused(aside, at.branch_x, -(along * at.branch_y)), V(0), V(0)};
  if constexpr (Law::has_rolling) {
    action.torque_i = fused(arm_i, f.tangential, f.moment);
    action.torque_j = fused(arm_j, f.tangential, -f.moment);
  } else {
    action.torque_i = arm_i * f.tangential;
    action.torque_j = arm_j * f.tangential;
  }
  return action;
}

/// What `act` gives where the law pushes only, up to the signs of zeros.
template <class Shape, class V>
KOKKOS_FORCEINLINE_FUNCTION PairAction<V> push(const Shape& shape, const PairGeometry<V>& at) {
  const PairDistance<V> distance = distance_of(at.gap, shape);
  const V along = shape.law.secant(distance.overlap) * distance.excess;
  return {-(along * at.branch_x), -(along * at.branch_y), V(0), V(0)};
}

template <class V>
KOKKOS_FORCEINLINE_FUNCTION void add_stress(SweepSums<V>& sums, const PairAction<V>& p, const PairGeometry<V>& at) {
  sums.stress_xx = fused(p.force_x, at.branch_x, sums.stress_xx);
  sums.stress_xy = fused(p.force_x, at.branch_y, sums.stress_xy);
  sums.stress_yx = fused(p.force_y, at.branch_x, sums.stress_yx);
  sums.stress_yy = fused(p.force_y, at.branch_y, sums.stress_yy);
}

}  // namespace voussoir::kernels
