#pragma once
/// One contact of a committed state: the line between the centres, and the forces that the law gives there. The lanes,
/// the blocks of a device and `committed_contacts` all use these functions, and have the same bits.

#include "kernels/contact/cell.hpp"
#include "kernels/contact/contact_law.hpp"

namespace voussoir::kernels {

/// The line from the centre of grain i to that of grain j. @tparam Number double, or lanes of doubles
template <class Number>
struct CentreLine {
  Number branch_x, branch_y;  ///< [m]
  Number normal_x, normal_y;  ///< unit vector along it
  Number length;              ///< of the branch [m]
  Number overlap;             ///< [m]
  Number overlap_to_branch;   ///< overlap / length
};

/// @param x, y from i to any image of j [m]
template <class Number>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION CentreLine<Number> centre_line(const Cell& cell, Number x, Number y,
                                                                         const Number& radius_i,
                                                                         const Number& radius_j) {
  cell.nearest(x, y);
  const Number length = Kokkos::sqrt(x * x + y * y);
  const Number overlap = radius_i + radius_j - length;
  return {x, y, x / length, y / length, length, overlap, overlap / length};
}

/// The forces of one call of the law without motion. @tparam Law over SingleLane<double>
/// @param history within its caps, as an evaluation leaves it
template <class Law>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION ContactForce<typename Law::Value> force_at_rest(
    const GrainMaterial& of_i, double radius_i, const GrainMaterial& of_j, double radius_j, double overlap,
    double overlap_to_branch, typename Law::History history) {
  using V = typename Law::Value;
  const Law law(Law::combine(of_i, radius_i, of_j, radius_j));
  const double reach = radius_i + radius_j;
  return law({V(overlap / reach), V(overlap_to_branch), V(0.0), V(0.0)}, history);
}

/// f_n alone [N]. A law's normal force has no memory (contact_law.hpp), so that no history is read, and the compiler
/// leaves out what the law computes for the other forces. @tparam Law over SingleLane<double>
template <class Law>
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION double normal_force_at_rest(const GrainMaterial& of_i, double radius_i,
                                                                      const GrainMaterial& of_j, double radius_j,
                                                                      double overlap, double overlap_to_branch,
                                                                      double length) {
  const auto force = force_at_rest<Law>(of_i, radius_i, of_j, radius_j, overlap, overlap_to_branch, no_history<Law>());
  return force.normal_to_branch[0] * length;
}

}  // namespace voussoir::kernels
