#pragma once
/// The contacts of a group at rest as springs, whose stiffnesses are the law's, and the forces of these springs when
/// grains move.
///
/// Each contact is one symmetric operator: the stiffnesses k_n, k_t / y and k_r act on the changes of length that
/// docs/explanation/contact_law.md names. The forces are the engine's own but for two differences of the order of
/// overlap / diameter: the torque arms are r/y instead of r - delta/2, and the rotation of the forces already carried
/// is left out.

#include <array>
#include <vector>

#include "kernels/contact/pair_forces.hpp"
#include "kernels/state/requests.hpp"

namespace voussoir::kernels {

inline constexpr int unit_strains = 3;  ///< xx, yy, gamma_xy

/// The motion of a grain under one unit strain, or its force and torque in the same places.
template <class V>
struct GrainDofs {
  V x, y, spin;
};

/// A contact as springs; all stiffnesses are 0 in lanes where the pair does not touch.
template <class V>
struct SpringLanes {
  V normal_x, normal_y, branch;   ///< n [-], |b| [m]
  V ratio;                        ///< y = R/|b|
  V normal, tangential, rolling;  ///< k_n, k_t / y [N/m], k_r [N m/rad]
};

/// The numbers of a contact that are the same in all lanes.
template <class real>
struct SpringShape {
  int other;
  real radius_other;
  int pair;  ///< its place in the group's list
};

template <class V>
using PerStrain = std::array<V, unit_strains>;

/// A grain's motions, or the forces on it, by unit strain.
template <class V>
using StrainDofs = std::array<GrainDofs<V>, unit_strains>;

/// The lower triangle of a 3 x 3 matrix over (x, y, spin), which is symmetric or has nothing above it.
template <class V>
struct Triangle {
  V xx, yx, yy, sx, sy, ss;
};

/// What two touching grains do to each other in the scaled stiffness (grain_blocks.hpp), negative: row of grain i,
/// column of grain j.
template <class V>
struct CouplingBlock {
  V xx, xy, xs, yx, yy, ys, sx, sy, ss;
};

/// Working arrays of one grain. Those of the conjugate gradients are scaled (grain_blocks.hpp), `motion` only until
/// they end.
template <class V>
struct SolverGrain {
  StrainDofs<V> motion, residual, direction;
  StrainDofs<V> image;   ///< of the direction: through the backward substitution, or the matrix (loading_tangent.hpp)
  StrainDofs<V> answer;  ///< of the forward substitution
  Triangle<V> scale;     ///< the inverse of the Cholesky factor of the grain's own block of K; 0 where K is
  GrainDofs<V> inverse_diagonal;  ///< of K, for a loading tangent; 0 where the grain has no stiffness
};

/// A spring in the row of its grain of the larger number.
struct SpringAbove {
  int grain;   ///< that of the smaller number
  int spring;  ///< its place in `springs`
};

/// The stiffness K of a group as its springs. The arrays are reused from group to group and never shrink.
template <class V>
struct SpringSystem {
  std::vector<int> row;  ///< springs of grain i: row[i] .. row[i + 1]; the first row.back() springs are in use
  std::vector<SpringLanes<V>> springs;
  std::vector<SpringShape<real_of<V>>> shapes;
  std::vector<V> overlaps;               ///< delta/R by spring [-]; 0 in lanes where the pair does not touch
  std::vector<CouplingBlock<V>> blocks;  ///< by spring
  std::vector<int> column;               ///< entries of `above` of grain i: column[i] .. column[i + 1]
  std::vector<SpringAbove> above;
  std::vector<real_of<V>> radii;
  std::vector<SolverGrain<V>> grains;

  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(row.back()); }
};

/// Adds to (dx, dy) the displacement of a branch's far end under unit strain `a`.
template <class V>
KOKKOS_FORCEINLINE_FUNCTION void add_unit_strain(int a, const SpringLanes<V>& s, V& dx, V& dy) {
  const V bx = s.branch * s.normal_x, by = s.branch * s.normal_y;
  const V half(real_of<V>(0.5));
  if (a == 0) dx = dx + bx;
  if (a == 1) dy = dy + by;
  if (a == 2) {
    dx = fused(half, by, dx);
    dy = fused(half, bx, dy);
  }
}

/// Changes of length of a contact's springs, as the contact law counts them (docs/explanation/contact_law.md).
template <class V>
struct SpringStrain {
  V normal, sliding, rolling;
  V across;  ///< displacement of the far end along t; over |b| it is the contact's rotation
};

/// The changes of length of a contact's springs. @param dx, dy displacement of grain j against i
template <class V>
KOKKOS_FORCEINLINE_FUNCTION SpringStrain<V> spring_strain(const SpringLanes<V>& s, const V& dx, const V& dy,
                                                          const V& radius_i, const V& spin_i, const V& radius_j,
                                                          const V& spin_j) {
  const V along = fused(dy, s.normal_x, -(dx * s.normal_y));
  return {fused(dx, s.normal_x, dy * s.normal_y), fused(s.ratio, along, -fused(radius_i, spin_i, radius_j * spin_j)),
          spin_j - spin_i, along};
}

/// Forces of a contact's springs, conjugate to their changes of length.
template <class V>
struct SpringForce {
  V normal, shear, moment;  ///< -f_n, f_t / y [N], m [N m]
};

template <class V>
KOKKOS_FORCEINLINE_FUNCTION SpringForce<V> force_of(const SpringLanes<V>& s, const SpringStrain<V>& e) {
  return {s.normal * e.normal, s.tangential * e.sliding, s.rolling * e.rolling};
}

/// Adds the springs' forces and torques on the two grains to `on_i` and `on_j`. Returns the force on i.
template <class V>
KOKKOS_FORCEINLINE_FUNCTION GrainDofs<V> pull(const SpringLanes<V>& s, const SpringForce<V>& f, const V& radius_i,
                                              const V& radius_j, GrainDofs<V>& on_i, GrainDofs<V>& on_j) {
  const V ft = s.ratio * f.shear;
  const V fx = fused(f.normal, s.normal_x, -(ft * s.normal_y));
  const V fy = fused(f.normal, s.normal_y, ft * s.normal_x);
  on_i = {on_i.x + fx, on_i.y + fy, fused(radius_i, f.shear, on_i.spin) + f.moment};
  on_j = {on_j.x - fx, on_j.y - fy, fused(radius_j, f.shear, on_j.spin) - f.moment};
  return {fx, fy, f.moment};
}

/// Share of its cap at which a spring counts as yielded; above 1, no spring does.
[[nodiscard]] KOKKOS_INLINE_FUNCTION double elastic_share(TangentKind kind) {
  return kind == TangentKind::static_ ? 1.0 - 1e-4 : 2.0;
}

/// A contact at rest as springs; a pair that does not touch has springs without stiffness. @param share elastic_share
template <class Law, class Shape, class V>
KOKKOS_FORCEINLINE_FUNCTION SpringLanes<V> spring_of(const PairLanes<Law>& pair, const Shape& shape,
                                                     const PairGeometry<V>& at, const PairDistance<V>& distance,
                                                     const V& share) {
  const V to_unit = distance.inverse_length;
  const ContactStiffness<V> k = Law(shape.law).stiffness(distance.overlap, pair.history, share);
  const V y = V(1) + distance.excess;
  return {at.branch_x * to_unit, at.branch_y * to_unit, V(1) / to_unit, y, k.normal, k.tangential / y, k.rolling};
}

/// Collects the springs of every pair that touches in at least one lane.
template <class Law, class V>
void collect_springs(const GroupState<Law>& group, TangentKind kind, SpringSystem<V>& system) {
  using real = real_of<V>;
  const V zero(0), share(static_cast<real>(elastic_share(kind)));
  const auto n = static_cast<std::size_t>(group.n_grains);
  system.row.assign(n + 1, 0);
  system.radii.resize(n);
  system.grains.resize(n);
  const auto most = static_cast<std::size_t>(group.row[n]);
  if (system.springs.size() < most) {
    system.springs.resize(most);
    system.shapes.resize(most);
    system.overlaps.resize(most);
    system.blocks.resize(most);
    system.above.resize(most);
  }
  std::size_t used = 0;
  for (std::size_t i = 0; i < n; ++i) {
    system.radii[i] = group.shapes[i].radius;
    for (auto p = static_cast<std::size_t>(group.row[i]); p < static_cast<std::size_t>(group.row[i + 1]); ++p) {
      const PairLanes<Law>& pair = group.pairs[p];
      const PairShape<Law>& shape = group.pair_shapes[p];
      const GrainLanes<V>& gj = group.grains[static_cast<std::size_t>(shape.other)];
      const auto at = geometry_of(pair, group.motion, gj.u_x - group.grains[i].u_x, gj.u_y - group.grains[i].u_y);
      if (!Kokkos::Experimental::any_of(at.gap < zero)) continue;
      const PairDistance<V> distance = distance_of(at.gap, shape);
      system.springs[used] = spring_of(pair, shape, at, distance, share);
      system.shapes[used] = {shape.other, shape.radius_other, static_cast<int>(p)};
      if (kind == TangentKind::loading) system.overlaps[used] = distance.overlap;
      ++used;
    }
    system.row[i + 1] = static_cast<int>(used);
  }
}

/// Calls body(c, i, j, radius_i, radius_j) for all springs c, in the order of the lists.
template <class V, class Body>
void for_each_spring(SpringSystem<V>& system, const Body& body) {
  for (std::size_t i = 0; i + 1 < system.row.size(); ++i) {
    for (auto c = static_cast<std::size_t>(system.row[i]); c < static_cast<std::size_t>(system.row[i + 1]); ++c) {
      const auto& shape = system.shapes[c];
      body(c, system.grains[i], system.grains[static_cast<std::size_t>(shape.other)], V(system.radii[i]),
           V(shape.radius_other));
    }
  }
}

/// Adds to forces(i) the forces of the contacts on grain i when all grains j move by motions(j); both return StrainDofs
/// of a grain. act(c, a, strain, radius_i, radius_j, on_i, on_j) adds the forces of contact c under motion a. The part
/// of grain i is summed in registers while its row is walked.
template <class V, class Motions, class Forces, class Act>
void respond(const SpringSystem<V>& system, const Motions& motions, const Forces& forces, const Act& act) {
  for (std::size_t i = 0; i + 1 < system.row.size(); ++i) {
    const StrainDofs<V> from = motions(i);
    StrainDofs<V> on = forces(i);
    const V ri(system.radii[i]);
    for (auto c = static_cast<std::size_t>(system.row[i]); c < static_cast<std::size_t>(system.row[i + 1]); ++c) {
      const SpringLanes<V>& s = system.springs[c];
      const auto j = static_cast<std::size_t>(system.shapes[c].other);
      const StrainDofs<V>& to = motions(j);
      StrainDofs<V>& on_j = forces(j);
      const V rj(system.shapes[c].radius_other);
      for (std::size_t a = 0; a < unit_strains; ++a) {
        act(c, a, spring_strain(s, to[a].x - from[a].x, to[a].y - from[a].y, ri, from[a].spin, rj, to[a].spin), ri, rj,
            on[a], on_j[a]);
      }
    }
    forces(i) = on;
  }
}

/// Total strain of spring c under unit strain `a` and the grains' motion in answer to it.
template <class V>
VOUSSOIR_LANES_INLINE SpringStrain<V> strain_of(const SpringLanes<V>& s, std::size_t a, const SolverGrain<V>& gi,
                                                const SolverGrain<V>& gj, const V& ri, const V& rj, V& dx, V& dy) {
  dx = gj.motion[a].x - gi.motion[a].x;
  dy = gj.motion[a].y - gi.motion[a].y;
  add_unit_strain(static_cast<int>(a), s, dx, dy);
  return spring_strain(s, dx, dy, ri, gi.motion[a].spin, rj, gj.motion[a].spin);
}

/// Adds twice the mixed energies of a contact in the three motions to the upper triangle `tangent`. @param e by unit
/// strain
template <class V>
KOKKOS_FORCEINLINE_FUNCTION void add_mixed_energies(const SpringLanes<V>& s, const SpringStrain<V>* e, V* tangent) {
  int entry = 0;
  for (int a = 0; a < unit_strains; ++a) {
    const V fn = s.normal * e[a].normal, ft = s.tangential * e[a].sliding, m = s.rolling * e[a].rolling;
    for (int b = a; b < unit_strains; ++b, ++entry) {
      tangent[entry] = fused(fn, e[b].normal, fused(ft, e[b].sliding, fused(m, e[b].rolling, tangent[entry])));
    }
  }
}

/// Adds twice the mixed energies of the three motions to the upper triangle `tangent`.
template <class V>
void add_energies(SpringSystem<V>& system, V* tangent) {
  for_each_spring(system,
                  [&](std::size_t c, const SolverGrain<V>& gi, const SolverGrain<V>& gj, const V& ri, const V& rj) {
                    const SpringLanes<V>& s = system.springs[c];
                    std::array<SpringStrain<V>, unit_strains> e;
                    V dx, dy;
                    for (std::size_t a = 0; a < unit_strains; ++a) e[a] = strain_of(s, a, gi, gj, ri, rj, dx, dy);
                    add_mixed_energies(s, e.data(), tangent);
                  });
}

}  // namespace voussoir::kernels
