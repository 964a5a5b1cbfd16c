#pragma once
/// The contact law as a value: named constants and one pure call (method.md §3; the rules are Yade's, so that the two
/// codes can be compared grain by grain). No views, no indices: it is tested alone along a path before any packing
/// exists.
///
/// A new law is a struct with this shape: `History` (what it remembers), `has_rolling`, constants, and `operator()`.

#include "kernels/contact/lane.hpp"

namespace voussoir::kernels {

/// What a grain is made of. One class of Table 1.
struct GrainMaterial {
  double modulus = 3.0e9;          ///< contact modulus E [Pa]
  double stiffness_ratio = 0.5;    ///< k_t/k_n [-]
  double friction = 0.466307658;   ///< tan(friction angle) [-]
  double rolling_stiffness = 1.0;  ///< beta in k_r = beta k_t r1 r2 [-]
  double rolling_limit = 0.6;      ///< eta in |m| <= eta r f_n [-]
};

/// Constants of one pair in contact.
struct PairConstants {
  double normal_stiffness;      ///< k_n [N/m]
  double tangential_stiffness;  ///< k_t [N/m]
  double rolling_stiffness;     ///< k_r [N m/rad]
  double friction;              ///< mu [-]
  double rolling_arm;           ///< min(eta_1 r_1, eta_2 r_2) [m]
};

/// Caps of the springs by overlap over R, as the law wants them.
struct PairCaps {
  double tangential;  ///< mu k_n R [N]
  double moment;      ///< [N m]
};

[[nodiscard]] KOKKOS_INLINE_FUNCTION PairCaps caps_of(const PairConstants& k, double sum_radii) {
  const double fn = k.normal_stiffness * sum_radii;
  return {k.friction * fn, k.rolling_arm * fn};
}

/// Harmonic mean 2 a b / (a + b), of two springs in series; 0 if either is 0.
KOKKOS_INLINE_FUNCTION double harmonic_mean(double a, double b) { return a + b > 0 ? 2.0 * a * b / (a + b) : 0.0; }

/// Combination rules of method.md §3 for grains of radii r1, r2 [m].
KOKKOS_INLINE_FUNCTION PairConstants combine(const GrainMaterial& m1, double r1, const GrainMaterial& m2, double r2) {
  const double kt = harmonic_mean(m1.modulus * m1.stiffness_ratio * r1, m2.modulus * m2.stiffness_ratio * r2);
  const double beta = harmonic_mean(m1.rolling_stiffness, m2.rolling_stiffness);
  const double arm1 = m1.rolling_limit * r1;
  const double arm2 = m2.rolling_limit * r2;
  return {.normal_stiffness = harmonic_mean(m1.modulus * r1, m2.modulus * r2),
          .tangential_stiffness = kt,
          .rolling_stiffness = beta * kt * r1 * r2,
          .friction = m1.friction < m2.friction ? m1.friction : m2.friction,
          .rolling_arm = arm1 < arm2 ? arm1 : arm2};
}

/// Relative motion at a contact during one step. A law that is linear in the overlap answers to it in two units, which
/// spares the sweep two products and every contact a wait: R = r_i + r_j, |b| the distance of the centres.
template <class V>
struct ContactMotion {
  V overlap;            ///< delta/R >= 0 [-]; 0 means no contact
  V overlap_to_branch;  ///< delta/|b| [-]
  V sliding;            ///< increment of the sliding of j past i along t [m]
  V rolling;            ///< increment of the relative rotation of j against i [rad]
};

template <class V>
struct ContactForce {
  V normal_to_branch;  ///< f_n/|b| >= 0, repulsion [N/m]
  V tangential;        ///< f_t on i along t [N]
  V moment;            ///< m on i [N m]
};

/// The law's springs at its state.
template <class V>
struct ContactStiffness {
  V normal, tangential, rolling;  ///< [N/m], [N/m], [N m/rad]
};

/// A spring force that may not pass a share of f_n, over a small motion.
template <class V>
struct LimitedForce {
  V change;      ///< of the force
  V slope;       ///< of `change` by the spring's own motion: 0 at the cap
  V by_closing;  ///< and by the contact's closing: 0 but at the cap
};

/// What a small motion changes in a contact's forces, and the slopes of that. Closing is the increase of the overlap
/// over R.
template <class V>
struct ContactStep {
  V closing;                           ///< as far as the contact follows it: an opening one does to its last touch [-]
  V normal_stiffness;                  ///< k_n; 0 where it opens [N/m]
  LimitedForce<V> tangential, moment;  ///< f_t [N], m [N m]
};

/// @param stiffness 0 where the contact opens; @param motion of the spring; @param held its force before, within its
/// cap
/// @param cap after the motion; @param cap_slope of it by closing
template <class V>
KOKKOS_FORCEINLINE_FUNCTION LimitedForce<V> limited_force(const V& stiffness, const V& motion, const V& held,
                                                          const V& cap, const V& cap_slope) {
  using Kokkos::Experimental::condition;
  const V zero(0), trial = stiffness * motion;
  const V lowest = -cap - held, highest = cap - held;
  const auto below = trial < lowest, above = highest < trial;
  return {condition(below, lowest, condition(above, highest, trial)), condition(below || above, zero, stiffness),
          condition(below, -cap_slope, condition(above, cap_slope, zero))};
}

/// Linear normal spring, tangential spring with Coulomb cap, rolling spring with plastic cap (Iwashita and Oda 1998).
template <class V, bool Rolling>
struct LinearContactLaw {
  static constexpr bool has_rolling = Rolling;

  /// Spring forces carried from step to step.
  struct History {
    V tangential;  ///< [N]
    V moment;      ///< [N m], untouched without rolling
  };

  V normal_stiffness, tangential_stiffness, rolling_stiffness;  ///< as in PairConstants
  V tangential_cap;                                             ///< mu k_n R, by overlap/R [N]
  V moment_cap;                                                 ///< min(eta_1 r_1, eta_2 r_2) k_n R, by overlap/R [N m]

  /// Without contact every force and the history become zero: both caps are multiples of f_n.
  KOKKOS_FORCEINLINE_FUNCTION ContactForce<V> operator()(const ContactMotion<V>& motion, History& history) const {
    const V fn = normal_stiffness * motion.overlap_to_branch;
    history.tangential = clamp_to(fused(tangential_stiffness, motion.sliding, history.tangential),
                                  tangential_cap * motion.overlap);
    if constexpr (Rolling) {
      history.moment = clamp_to(fused(rolling_stiffness, motion.rolling, history.moment), moment_cap * motion.overlap);
      return {fn, history.tangential, history.moment};
    } else {
      return {fn, history.tangential, V(0)};
    }
  }

  /// Its derivative by the motion, with the springs that have yielded left out (their force follows f_n only, which has
  /// no potential and is neglected). @param overlap over R [-]; @param history within the caps, as the call above
  /// leaves it
  /// @param elastic_share share of its cap below which a spring holds; above 1, all do that have a cap
  KOKKOS_FORCEINLINE_FUNCTION ContactStiffness<V> stiffness(const V& overlap, const History& history,
                                                            const V& elastic_share) const {
    const V zero(0);
    const auto touches = zero < overlap;
    const V pressed = larger(overlap, zero);
    const auto sticks = Kokkos::abs(history.tangential) < elastic_share * (tangential_cap * pressed);
    ContactStiffness<V> k{Kokkos::Experimental::condition(touches, normal_stiffness, zero),
                          Kokkos::Experimental::condition(sticks, tangential_stiffness, zero), zero};
    if constexpr (Rolling) {
      const auto holds = Kokkos::abs(history.moment) < elastic_share * (moment_cap * pressed);
      k.rolling = Kokkos::Experimental::condition(holds, rolling_stiffness, zero);
    }
    return k;
  }

  /// What operator() changes in the forces of a contact that touches, without its cancellation; a contact that does not
  /// stays away.
  /// @param overlap over R, and history, at rest, within the caps; @param closing increase of the overlap over R
  /// @param sliding, rolling as in ContactMotion
  KOKKOS_FORCEINLINE_FUNCTION ContactStep<V> step(const V& overlap, const History& history, const V& closing,
                                                  const V& sliding, const V& rolling) const {
    using Kokkos::Experimental::condition;
    const V zero(0);
    const auto stays = (zero < overlap) && (zero < overlap + closing);
    const V followed = condition(stays, closing, -overlap), pressed = overlap + followed;
    const auto where_it_stays = [&](const V& x) { return condition(stays, x, zero); };
    ContactStep<V> out{followed,
                       where_it_stays(normal_stiffness),
                       limited_force(where_it_stays(tangential_stiffness), sliding, history.tangential,
                                     tangential_cap * pressed, where_it_stays(tangential_cap)),
                       {zero, zero, zero}};
    if constexpr (Rolling) {
      out.moment = limited_force(where_it_stays(rolling_stiffness), rolling, history.moment, moment_cap * pressed,
                                 where_it_stays(moment_cap));
    }
    return out;
  }
};

}  // namespace voussoir::kernels
