#pragma once
/// One pair at rest and its parts of stress and tangent, by one law call with zero motion.
///
/// Love-Weber stress, eq. (3): sigma = (1/V) sum P (x) b. Contact tangent, eq. (4): D = (1/V) sum k_n n b n b + k_t t b
/// t b, symmetrised for the FEM. This tangent lets every grain follow the mean strain, which makes it too stiff by a
/// factor of 1.2 to 3, and it neglects spins.

#include "kernels/contact/pair_forces.hpp"

namespace voussoir::kernels {

/// Sums over all contacts. Divided by the volume they are stress and tangent (upper triangle, Voigt order xx, yy, xy).
template <class V>
struct Homogenised {
  SweepSums<V> sums;
  V tangent[6] = {V(0), V(0), V(0), V(0), V(0), V(0)};  ///< xxxx, xxyy, xxxy, yyyy, yyxy, xyxy [N m]
  V contacts = V(0);
  V overlaps = V(0);  ///< sum of overlap / (r_i + r_j) over the contacts
};

/// A spring of stiffness k along a direction: k s (x) s with s = sym(direction (x) branch) in Voigt form.
template <class V>
struct SpringTerms {
  V xx, yy, xy;     ///< s
  V kxx, kyy, kxy;  ///< k s

  /// Entry `c` of the tangent's upper triangle, with the part of this spring added.
  [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION V added_to(int c, const V& tangent) const {
    const V& left = c < 3 ? kxx : (c < 5 ? kyy : kxy);
    const V& right = c == 0 ? xx : (c == 1 || c == 3 ? yy : xy);
    return fused(left, right, tangent);
  }
};

template <class V>
KOKKOS_FORCEINLINE_FUNCTION SpringTerms<V> spring_terms(const V& k, const V& dx, const V& dy,
                                                        const PairGeometry<V>& at) {
  const V xx = dx * at.branch_x;
  const V yy = dy * at.branch_y;
  const V xy = V(real_of<V>(0.5)) * fused(dx, at.branch_y, dy * at.branch_x);
  return {xx, yy, xy, k * xx, k * yy, k * xy};
}

/// A pair at rest.
template <class V>
struct RestingPair {
  PairAction<V> action;
  SpringTerms<V> normal, tangential;  ///< zero where the pair does not touch
  V weight;                           ///< 1, or 0 where it does not touch
  V overlap;                          ///< e = -g/R^2
};

/// The pair at its present position. Its history is limited by the caps at this position, as the next step would limit
/// it.
template <class Law, class V>
KOKKOS_FORCEINLINE_FUNCTION RestingPair<V> rest(PairLanes<Law>& pair, const PairShape<Law>& shape,
                                                const PairGeometry<V>& at, const CellMotion<V>& cell,
                                                const V& radius_i) {
  const V zero(0), one(1);
  CellMotion<V> still = cell;
  still.d_xy = still.d_difference = zero;
  RestingPair<V> out;
  out.action = act(pair, shape, at, still, zero, zero, rim_of(radius_i, zero), zero);
  out.weight = Kokkos::Experimental::condition(at.gap < zero, one, zero);
  out.overlap = overlap_measure(at, shape);
  const PairDistance<V> distance = distance_of(at.gap, shape);
  const V nx = at.branch_x * distance.inverse_length, ny = at.branch_y * distance.inverse_length;
  const ContactStiffness<V> k = Law(shape.law).springs(distance.overlap);
  out.normal = spring_terms(out.weight * k.normal, nx, ny, at);
  out.tangential = spring_terms(out.weight * k.tangential, -ny, nx, at);
  return out;
}

/// overlap / (r_i + r_j) from e = -g/R^2; 0 where the pair does not touch (`weight` 0).
template <class V>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION V overlap_ratio(const V& e, const V& weight) {
  const V zero(0), one(1);
  return Kokkos::Experimental::condition(zero < weight, one - Kokkos::sqrt(one - smaller(e, one)), zero);
}

/// Adds the pair to the sums.
template <class V>
KOKKOS_FORCEINLINE_FUNCTION void add_pair(Homogenised<V>& out, const RestingPair<V>& pair, const PairGeometry<V>& at) {
  add_stress(out.sums, pair.action, at);
  for (int c = 0; c < 6; ++c) {
    out.tangent[c] = pair.tangential.added_to(c, pair.normal.added_to(c, out.tangent[c]));
  }
  out.contacts = out.contacts + pair.weight;
  out.overlaps = out.overlaps + overlap_ratio(pair.overlap, pair.weight);
  out.sums.largest_measure = larger(out.sums.largest_measure, pair.overlap);
}

}  // namespace voussoir::kernels
