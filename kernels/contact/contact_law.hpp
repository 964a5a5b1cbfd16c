#pragma once
/// The questions that the engine asks a contact law, and the form of the answers. A law itself is a value: the
/// constants of one contact and pure functions of its motion, without views and without indices, so that it can be
/// tested alone along a path. The engine runs the law of `linear_law.hpp`; `engine_law.hpp` makes that choice.
///
/// A law is a struct `Law` over a value type V (lane.hpp) with
///
///   Value, has_rolling      V, and whether contacts transmit moments; if not, the sweep leaves moments out
///   Pair                    the law's constants for two given grains, in V's real type and the same in all lanes
///   combine(m1, r1, m2, r2) the Pair of two grains (materials, radii [m]), computed in the numbers' own precision, and
///                           rounded once
///   History                 the memory of a contact: at most four numbers of type V, 0 before the first touch
///   history_names           their names in the order in which packings and checkpoints store them
///   for_each_number(h, f)   calls f(k, number k) of a History, in that order
///   stable_rows(...)        row sums of a grain's stiffness at the largest overlap allowed; its scaled mass follows
///   normal_stiffness_of(...) d f_n/d delta of a grain against an equal one, for the control of stresses
///   pushes_only(pair)       optional: whether that pair has neither f_t nor m, whatever its motion and history, so
///                           that a step needs neither of them (packings consolidated without friction)
///   Law(pair)               the law of that pair, with the member functions
///     operator()(motion, history)    forces; the history becomes 0 where the grains do not touch
///     keep(changed, history)         copies the numbers that operator() can change from `changed` to `history`;
///                                    the sweep works on a copy in registers and writes no other numbers back
///     secant(overlap)                f_n/delta
///     springs(overlap)               derivatives of the forces as if there were no caps
///     stiffness(overlap, history, elastic_share)   these derivatives without the springs that have yielded
///     step(overlap, history, closing, sliding, rolling)   the changes of the forces by a small motion
///
/// The engine relies on two properties that no compiler checks. The normal force is a function of the overlap alone:
/// `secant` and `springs` see no history, and a law whose f_n remembers needs a history as their argument. A call
/// without motion changes neither forces nor history: lanes that have come to rest, `finish` and `committed_contacts`
/// repeat the call.
///
/// A law's members are values of type V and nothing else, and V is the first argument of its template: an RVE that is
/// spread over the lanes gives each lane the law of another pair (lanes/spread_rve.hpp).
///
/// Overlaps are given over R = r_i + r_j, because the sweep has that number at no cost: a law that is not linear in
/// delta takes its powers from overlap and keeps the power of R in its Pair.

#include <array>
#include <string_view>

#include "kernels/contact/lane.hpp"

namespace voussoir::kernels {

/// The material of a grain, one class of Table 1. A law reads the numbers that it needs. @tparam Number double, but
/// where a device makes a pair's constants anew at each step: there it is the sweep's own precision
template <class Number>
struct GrainMaterialOf {
  Number modulus = Number(3.0e9);          ///< contact modulus E [Pa]
  Number stiffness_ratio = Number(0.5);    ///< k_t/k_n [-]
  Number friction = Number(0.466307658);   ///< tan(friction angle) [-]
  Number rolling_stiffness = Number(1.0);  ///< beta in k_r = beta k_t r1 r2 [-]
  Number rolling_limit = Number(0.6);      ///< eta in |m| <= eta r f_n [-]
};
using GrainMaterial = GrainMaterialOf<double>;

/// One number of a material, and its name in the recipes of stored packings.
using MaterialMember = double GrainMaterial::*;
struct MaterialNumber {
  std::string_view name;
  MaterialMember number;
};

/// All numbers of a material. The recipe of a stored packing and the identity of a checkpoint hold them in this order,
/// so that neither is taken for grains of another material.
inline constexpr std::array<MaterialNumber, 5> material_numbers{{{"E", &GrainMaterial::modulus},
                                                                 {"kt/kn", &GrainMaterial::stiffness_ratio},
                                                                 {"mu", &GrainMaterial::friction},
                                                                 {"beta", &GrainMaterial::rolling_stiffness},
                                                                 {"eta", &GrainMaterial::rolling_limit}}};
static_assert(sizeof(GrainMaterial) == material_numbers.size() * sizeof(double),
              "material_numbers must hold every member of GrainMaterial, once");

/// Relative motion at a contact during one step. The overlap is given as a ratio to each of two lengths, R = r_i + r_j
/// and the distance |b| of the centres: caps follow the first ratio, and f_n/|b| is the secant stiffness times the
/// second. The sweep knows both ratios; a law that received only one would need two more products, for which every
/// contact would wait.
template <class V>
struct ContactMotion {
  V overlap;            ///< delta/R >= 0 [-]; 0 means no contact
  V overlap_to_branch;  ///< delta/|b| [-]
  V sliding;            ///< increment of the sliding of j past i along t [m]
  V rolling;            ///< increment of the relative rotation of j against i [rad]
};

/// Whether a pair of this law is known to have no force but f_n.
template <class Law>
[[nodiscard]] bool pushes_only(const typename Law::Pair& pair) {
  if constexpr (requires { Law::pushes_only(pair); }) {
    return Law::pushes_only(pair);
  } else {
    return false;
  }
}

template <class V>
struct ContactForce {
  V normal_to_branch;  ///< f_n/|b| >= 0, repulsion [N/m]
  V tangential;        ///< f_t on i along t [N]
  V moment;            ///< m on i [N m]
};

/// The stiffnesses of a contact's springs at its present state.
template <class V>
struct ContactStiffness {
  V normal, tangential, rolling;  ///< [N/m], [N/m], [N m/rad]
};

/// The change of a spring force by a small motion, where the force is limited to a share of f_n.
template <class V>
struct LimitedForce {
  V change;      ///< of the force
  V slope;       ///< derivative of `change` by the spring's own motion: 0 at the cap
  V by_closing;  ///< derivative of `change` by the contact's closing: 0 except at the cap
};

/// The changes of a contact's forces by a small motion, and the slopes of these changes. Closing is the increase of
/// overlap/R. A contact that opens loses its forces and is followed no further.
template <class V>
struct ContactStep {
  V normal_change;                     ///< of f_n, over R [N/m]
  V normal_stiffness;                  ///< derivative of f_n by delta after the motion; 0 where the contact opens [N/m]
  LimitedForce<V> tangential, moment;  ///< f_t [N], m [N m]
};

/// Sums over the rows of a grain's stiffness matrix, which bound its eigenvalues (Gershgorin): an explicit step is
/// stable for them.
struct StableRows {
  double translation;  ///< [N/m]
  double rotation;     ///< [N m/rad]
};

/// The change of a spring's force by its motion, limited so that the force stays between -cap and cap.
/// @param stiffness of the spring, 0 where the contact opens; @param held force before the motion, within its cap
/// @param cap after the motion; @param cap_slope derivative of the cap by closing
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

inline constexpr std::size_t most_history_numbers = 4;

/// How many numbers a law's History has.
template <class Law>
inline constexpr int history_size = [] {
  static_assert(Law::history_names.size() <= most_history_numbers);
  return static_cast<int>(Law::history_names.size());
}();

/// The history of one lane as plain numbers, in the order in which states store them.
template <class Law, class Number>
using HistoryNumbers = std::array<Number, static_cast<std::size_t>(history_size<Law>)>;

/// The same law over another value type. The value type is the first argument of a law's template; a second one may say
/// whether grains resist rolling.
template <class Law, class V>
struct LawOver;
template <template <class, bool> class Law, class Value, bool rolling, class V>
struct LawOver<Law<Value, rolling>, V> {
  using type = Law<V, rolling>;
};
template <template <class> class Law, class Value, class V>
struct LawOver<Law<Value>, V> {
  using type = Law<V>;
};

/// The history of a contact that has never touched.
template <class Law>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION typename Law::History no_history() {
  typename Law::History history;
  Law::for_each_number(history, [](int, typename Law::Value& number) { number = typename Law::Value(0); });
  return history;
}

/// Sets lane `l` of a history to the numbers numbers(k), rounded.
template <class Law, class Numbers>
KOKKOS_FORCEINLINE_FUNCTION void read_history(typename Law::History& history, std::size_t l, const Numbers& numbers) {
  Law::for_each_number(history, [&](int k, typename Law::Value& number) {
    number[l] = static_cast<real_of<typename Law::Value>>(numbers(k));
  });
}
/// Calls write(k, number) for the numbers that lane `l` of a history holds.
template <class Law, class Write>
KOKKOS_FORCEINLINE_FUNCTION void write_history(const typename Law::History& history, std::size_t l,
                                               const Write& write) {
  Law::for_each_number(history, [&](int k, const typename Law::Value& number) { write(k, number[l]); });
}

/// Whether lane `l` of a history holds a number other than 0, which a new list must take over.
template <class Law>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION bool remembers(const typename Law::History& history, std::size_t l) {
  bool any = false;
  Law::for_each_number(history, [&](int, const typename Law::Value& number) { any = any || number[l] != 0; });
  return any;
}

}  // namespace voussoir::kernels
