#pragma once
/// The linear law: a normal spring, a tangential spring with Coulomb's cap, and a rolling spring with a plastic cap
/// (Iwashita and Oda 1998). Its rules are Yade's, so that the two codes can be compared grain by grain.

#include "kernels/contact/contact_law.hpp"

namespace voussoir::kernels {

/// Constants of one pair in contact.
template <class Number>
struct PairConstantsOf {
  Number normal_stiffness;      ///< k_n [N/m]
  Number tangential_stiffness;  ///< k_t [N/m]
  Number rolling_stiffness;     ///< k_r [N m/rad]
  Number friction;              ///< mu [-]
  Number rolling_arm;           ///< min(eta_1 r_1, eta_2 r_2) [m]
};
using PairConstants = PairConstantsOf<double>;

/// Caps of the springs, divided by overlap/R.
template <class Number>
struct PairCapsOf {
  Number tangential;  ///< mu k_n R [N]
  Number moment;      ///< [N m]
};
using PairCaps = PairCapsOf<double>;

template <class Number>
[[nodiscard]] KOKKOS_INLINE_FUNCTION PairCapsOf<Number> caps_of(const PairConstantsOf<Number>& k, Number sum_radii) {
  const Number fn = k.normal_stiffness * sum_radii;
  return {k.friction * fn, k.rolling_arm * fn};
}

/// Harmonic mean 2 a b / (a + b), of two springs in series; 0 if either is 0.
template <class Number>
KOKKOS_INLINE_FUNCTION Number harmonic_mean(Number a, Number b) {
  return a + b > 0 ? Number(2) * a * b / (a + b) : Number(0);
}

/// Constants of a contact of two grains of radii r1, r2 [m]; docs/explanation/contact_law.md.
template <class Number>
KOKKOS_INLINE_FUNCTION PairConstantsOf<Number> combine(const GrainMaterialOf<Number>& m1, Number r1,
                                                       const GrainMaterialOf<Number>& m2, Number r2) {
  const Number kt = harmonic_mean(m1.modulus * m1.stiffness_ratio * r1, m2.modulus * m2.stiffness_ratio * r2);
  const Number beta = harmonic_mean(m1.rolling_stiffness, m2.rolling_stiffness);
  const Number arm1 = m1.rolling_limit * r1;
  const Number arm2 = m2.rolling_limit * r2;
  return {.normal_stiffness = harmonic_mean(m1.modulus * r1, m2.modulus * r2),
          .tangential_stiffness = kt,
          .rolling_stiffness = beta * kt * r1 * r2,
          .friction = m1.friction < m2.friction ? m1.friction : m2.friction,
          .rolling_arm = arm1 < arm2 ? arm1 : arm2};
}

template <class V, bool Rolling>
struct LinearContactLaw {
  using Value = V;
  static constexpr bool has_rolling = Rolling;

  /// Constants of one pair, in the sweep's precision.
  struct Pair {
    real_of<V> normal_stiffness, tangential_stiffness, rolling_stiffness;  ///< as in PairConstants
    real_of<V> tangential_cap, moment_cap;                                 ///< as in PairCaps
  };

  /// Spring forces carried from step to step.
  struct History {
    V tangential;  ///< [N]
    V moment;      ///< [N m], neither read nor written without rolling
  };
  static constexpr std::array<std::string_view, 2> history_names{"tangential_force", "rolling_moment"};

  template <class Numbers, class Call>
  KOKKOS_FORCEINLINE_FUNCTION static void for_each_number(Numbers& history, const Call& call) {
    call(0, history.tangential);
    call(1, history.moment);
  }

  /// Takes over the numbers that operator() changes.
  KOKKOS_FORCEINLINE_FUNCTION static void keep(const History& changed, History& history) {
    history.tangential = changed.tangential;
    if constexpr (Rolling) history.moment = changed.moment;
  }

  template <class Number>
  [[nodiscard]] KOKKOS_INLINE_FUNCTION static Pair combine(const GrainMaterialOf<Number>& m1, Number r1,
                                                           const GrainMaterialOf<Number>& m2, Number r2) {
    const PairConstantsOf<Number> c = kernels::combine(m1, r1, m2, r2);
    const PairCapsOf<Number> caps = caps_of(c, r1 + r2);
    const auto rounded = [](Number x) { return static_cast<real_of<V>>(x); };
    return {.normal_stiffness = rounded(c.normal_stiffness),
            .tangential_stiffness = rounded(c.tangential_stiffness),
            .rolling_stiffness = rounded(c.rolling_stiffness),
            .tangential_cap = rounded(caps.tangential),
            .moment_cap = rounded(caps.moment)};
  }

  [[nodiscard]] static bool pushes_only(const Pair& pair) {
    return pair.tangential_cap == 0 && (!Rolling || pair.moment_cap == 0);
  }

  /// @param overlap largest, divided by R; the stiffness of the linear law does not depend on it
  [[nodiscard]] static double normal_stiffness_of(const GrainMaterial& m, double radius,
                                                  [[maybe_unused]] double overlap) {
    return m.modulus * radius;
  }

  /// Row sums of a grain with `contacts` contacts. For displacements its neighbours are taken to be equal to it; for
  /// rotations it rolls on the packing's largest grains, which is the stiffest rotation of a small grain.
  /// @param radius, largest_radius [m]; @param overlap largest, divided by R
  [[nodiscard]] static StableRows stable_rows(const GrainMaterial& m, double radius, double largest_radius,
                                              double contacts, double overlap) {
    const double kn = normal_stiffness_of(m, radius, overlap);
    const double kt = m.stiffness_ratio * kn;
    const double kt_of_spin = m.stiffness_ratio * m.modulus * radius;  // equals kt up to rounding; both forms stay, so
                                                                       // that results keep their bits
    const double ratio = largest_radius / radius;
    const double rolling = m.rolling_stiffness * 2.0 * ratio * ratio / (1.0 + ratio);  // k_r/(k_t r^2)
    return {.translation = contacts * (kn + 2.0 * kt),
            .rotation = contacts * (4.0 + 2.0 * rolling) * kt_of_spin * radius * radius};
  }

  V normal_stiffness, tangential_stiffness, rolling_stiffness, tangential_cap, moment_cap;  ///< Pair in all lanes

  KOKKOS_FORCEINLINE_FUNCTION explicit LinearContactLaw(const Pair& pair)
      : normal_stiffness(pair.normal_stiffness),
        tangential_stiffness(pair.tangential_stiffness),
        rolling_stiffness(pair.rolling_stiffness),
        tangential_cap(pair.tangential_cap),
        moment_cap(pair.moment_cap) {}

  /// Without contact every force and the history become zero: both caps are multiples of f_n.
  KOKKOS_FORCEINLINE_FUNCTION ContactForce<V> operator()(const ContactMotion<V>& motion, History& history) const {
    const V fn = secant(motion.overlap) * motion.overlap_to_branch;
    history.tangential = clamp_to(fused(tangential_stiffness, motion.sliding, history.tangential),
                                  tangential_cap * motion.overlap);
    if constexpr (Rolling) {
      history.moment = clamp_to(fused(rolling_stiffness, motion.rolling, history.moment), moment_cap * motion.overlap);
      return {fn, history.tangential, history.moment};
    } else {
      return {fn, history.tangential, V(0)};
    }
  }

  /// f_n/delta [N/m]. This number times overlap/length is f_n/length, for any length.
  KOKKOS_FORCEINLINE_FUNCTION const V& secant([[maybe_unused]] const V& overlap) const { return normal_stiffness; }

  /// Derivatives of the forces by the motion at an overlap, as if there were no caps.
  KOKKOS_FORCEINLINE_FUNCTION ContactStiffness<V> springs([[maybe_unused]] const V& overlap) const {
    return {normal_stiffness, tangential_stiffness, rolling_stiffness};
  }

  /// Derivatives of the forces without the springs that have yielded. The force of a yielded spring follows f_n alone;
  /// this dependence has no potential and is neglected.
  /// @param overlap divided by R [-]; @param history within the caps, as operator() leaves it
  /// @param elastic_share share of its cap below which a spring holds; above 1, every spring with a cap holds
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

  /// The change of the forces that operator() would give, computed without the cancellation of a difference. A pair
  /// that does not touch is taken to stay apart.
  /// @param overlap divided by R, at rest; @param history at rest, within the caps; @param closing increase of
  /// overlap/R
  /// @param sliding, rolling as in ContactMotion
  KOKKOS_FORCEINLINE_FUNCTION ContactStep<V> step(const V& overlap, const History& history, const V& closing,
                                                  const V& sliding, const V& rolling) const {
    using Kokkos::Experimental::condition;
    const V zero(0);
    const auto stays = (zero < overlap) && (zero < overlap + closing);
    const V followed = condition(stays, closing, -overlap), pressed = overlap + followed;
    const auto where_it_stays = [&](const V& x) { return condition(stays, x, zero); };
    ContactStep<V> out{normal_stiffness * followed,
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
