#pragma once
/// A second contact law, for tests: spheres after Hertz, f_n = K delta^(3/2), without friction, rolling or memory. It
/// shows what a law must bring (kernels/contact/contact_law.hpp), and that the engine runs with one that is not linear.

#include <cmath>

#include "kernels/contact/contact_law.hpp"

namespace voussoir::kernels {

/// K = 4/3 E* sqrt(r*) [N/m^1.5] with 1/E* = 1/E_1 + 1/E_2 and 1/r* = 1/r_1 + 1/r_2.
template <class Number>
[[nodiscard]] KOKKOS_INLINE_FUNCTION Number hertz_constant(const GrainMaterialOf<Number>& m1, Number r1,
                                                           const GrainMaterialOf<Number>& m2, Number r2) {
  const Number modulus = m1.modulus * m2.modulus / (m1.modulus + m2.modulus);
  return Number(4.0 / 3.0) * modulus * Kokkos::sqrt(r1 * r2 / (r1 + r2));
}

template <class V>
struct HertzLaw {
  using Value = V;
  static constexpr bool has_rolling = false;

  struct Pair {
    real_of<V> secant_at_one;  ///< K sqrt(R): f_n/delta were the overlap R [N/m]
  };

  struct History {};
  static constexpr std::array<std::string_view, 0> history_names{};
  template <class Numbers, class Call>
  KOKKOS_FORCEINLINE_FUNCTION static void for_each_number(Numbers&, const Call&) {}

  KOKKOS_FORCEINLINE_FUNCTION static void keep(const History&, History&) {}

  template <class Number>
  [[nodiscard]] KOKKOS_INLINE_FUNCTION static Pair combine(const GrainMaterialOf<Number>& m1, Number r1,
                                                           const GrainMaterialOf<Number>& m2, Number r2) {
    return {static_cast<real_of<V>>(hertz_constant(m1, r1, m2, r2) * Kokkos::sqrt(r1 + r2))};
  }

  [[nodiscard]] static double normal_stiffness_of(const GrainMaterial& m, double radius, double overlap) {
    return 1.5 * hertz_constant(m, radius, m, radius) * std::sqrt(overlap * 2.0 * radius);
  }
  [[nodiscard]] static StableRows stable_rows(const GrainMaterial& m, double radius, double, double contacts,
                                              double overlap) {
    return {.translation = contacts * normal_stiffness_of(m, radius, overlap), .rotation = 0};
  }

  V secant_at_one;

  KOKKOS_FORCEINLINE_FUNCTION explicit HertzLaw(const Pair& pair) : secant_at_one(pair.secant_at_one) {}

  KOKKOS_FORCEINLINE_FUNCTION V secant(const V& overlap) const { return secant_at_one * Kokkos::sqrt(overlap); }
  KOKKOS_FORCEINLINE_FUNCTION ContactForce<V> operator()(const ContactMotion<V>& motion, History&) const {
    return {secant(motion.overlap) * motion.overlap_to_branch, V(0), V(0)};
  }
  KOKKOS_FORCEINLINE_FUNCTION ContactStiffness<V> springs(const V& overlap) const {
    return {V(real_of<V>(1.5)) * secant(overlap), V(0), V(0)};
  }
  KOKKOS_FORCEINLINE_FUNCTION ContactStiffness<V> stiffness(const V& overlap, const History&, const V&) const {
    return springs(overlap);
  }
  KOKKOS_FORCEINLINE_FUNCTION ContactStep<V> step(const V& overlap, const History&, const V& closing, const V&,
                                                  const V&) const {
    const V zero(0), after = larger(overlap + closing, zero);
    const V pressed = Kokkos::Experimental::condition(zero < overlap, after, zero);
    return {secant(pressed) * pressed - secant(overlap) * overlap,
            springs(pressed).normal,
            {zero, zero, zero},
            {zero, zero, zero}};
  }
};

}  // namespace voussoir::kernels
