#pragma once
/// The stiffness K of a group in the form in which it is solved: scaled so that the block of each grain over (x, y,
/// spin) is the identity, K = C (I + L + L^T) C^T with C the Cholesky factors of the blocks, and L as one block for
/// each pair that touches. Motions are scaled by C^T, forces by C^-1.
///
/// With the grains' blocks gone, I + L and I + L^T are triangular and need no divisions, and the symmetric
/// Gauss-Seidel preconditioner (I + L)(I + L^T) costs nothing beyond the product with K (Eisenstat 1981,
/// static_tangent.hpp).

#include <Kokkos_NumericTraits.hpp>

#include "kernels/tangents/contact_springs.hpp"

namespace voussoir::kernels {

/// A contact's changes of length by the motion of one of its grains: (x, y, spin) of the sliding spring. The normal
/// spring has the normal, the rolling spring has the spin alone.
template <class V>
KOKKOS_FORCEINLINE_FUNCTION GrainDofs<V> sliding_of(const SpringLanes<V>& s, const V& radius) {
  return {-(s.ratio * s.normal_y), s.ratio * s.normal_x, radius};
}

/// Adds a contact's part of the block of one of its grains. @param radius positive for i, negative for j
template <class V>
KOKKOS_FORCEINLINE_FUNCTION void add_block(const SpringLanes<V>& s, const V& radius, Triangle<V>& block) {
  const GrainDofs<V> along = sliding_of(s, radius);
  const V nx = s.normal * s.normal_x, ny = s.normal * s.normal_y;
  const V tx = s.tangential * along.x, ty = s.tangential * along.y, ts = s.tangential * along.spin;
  block.xx = fused(nx, s.normal_x, fused(tx, along.x, block.xx));
  block.yx = fused(ny, s.normal_x, fused(ty, along.x, block.yx));
  block.yy = fused(ny, s.normal_y, fused(ty, along.y, block.yy));
  block.sx = fused(ts, along.x, block.sx);
  block.sy = fused(ts, along.y, block.sy);
  block.ss = fused(ts, along.spin, block.ss) + s.rolling;
}

template <class V>
VOUSSOIR_LANES_INLINE V inverse_or_zero(const V& x) {
  return Kokkos::Experimental::condition(V(0) < x, V(1) / x, V(0));
}

/// 1 / sqrt(pivot), or 0 where the pivot is nothing but the rounding of `whole`: such a motion has no stiffness, or the
/// grain's other motions have it too, and it is left out.
template <class V>
KOKKOS_FORCEINLINE_FUNCTION V inverse_root(const V& pivot, const V& whole) {
  constexpr real_of<V> resolution = 64 * Kokkos::Experimental::epsilon_v<real_of<V>>;
  return Kokkos::Experimental::condition(V(resolution) * whole < pivot, V(1) / Kokkos::sqrt(pivot), V(0));
}

/// The inverse of the Cholesky factor of a grain's block.
template <class V>
KOKKOS_FORCEINLINE_FUNCTION Triangle<V> scale_of(const Triangle<V>& block) {
  Triangle<V> m;
  m.xx = inverse_root(block.xx, block.xx);
  const V yx = block.yx * m.xx, sx = block.sx * m.xx;
  m.yy = inverse_root(fused(-yx, yx, block.yy), block.yy);
  const V sy = fused(-sx, yx, block.sy) * m.yy;
  m.ss = inverse_root(fused(-sy, sy, fused(-sx, sx, block.ss)), block.ss);
  m.yx = -(m.yy * yx * m.xx);
  m.sy = -(m.ss * sy * m.yy);
  m.sx = -(m.ss * fused(sx, m.xx, sy * m.yx));
  return m;
}

/// m a
template <class V>
KOKKOS_FORCEINLINE_FUNCTION GrainDofs<V> scaled(const Triangle<V>& m, const GrainDofs<V>& a) {
  return {m.xx * a.x, fused(m.yx, a.x, m.yy * a.y), fused(m.sx, a.x, fused(m.sy, a.y, m.ss * a.spin))};
}

/// m^T a
template <class V>
KOKKOS_FORCEINLINE_FUNCTION GrainDofs<V> unscaled(const Triangle<V>& m, const GrainDofs<V>& a) {
  return {fused(m.xx, a.x, fused(m.yx, a.y, m.sx * a.spin)), fused(m.yy, a.y, m.sy * a.spin), m.ss * a.spin};
}

/// The block of a contact between the grains with the scales `mi` and `mj`.
template <class V>
VOUSSOIR_LANES_INLINE CouplingBlock<V> coupling(const SpringLanes<V>& s, const V& radius_i, const V& radius_j,
                                                const Triangle<V>& mi, const Triangle<V>& mj) {
  const GrainDofs<V> normal{s.normal_x, s.normal_y, V(0)};
  const GrainDofs<V> ni = scaled(mi, normal), nj = scaled(mj, normal);
  const GrainDofs<V> ti = scaled(mi, sliding_of(s, radius_i)), tj = scaled(mj, sliding_of(s, -radius_j));
  const V nx = s.normal * ni.x, ny = s.normal * ni.y, ns = s.normal * ni.spin;
  const V tx = s.tangential * ti.x, ty = s.tangential * ti.y, ts = s.tangential * ti.spin;
  return {fused(nx, nj.x, tx * tj.x),
          fused(nx, nj.y, tx * tj.y),
          fused(nx, nj.spin, tx * tj.spin),
          fused(ny, nj.x, ty * tj.x),
          fused(ny, nj.y, ty * tj.y),
          fused(ny, nj.spin, ty * tj.spin),
          fused(ns, nj.x, ts * tj.x),
          fused(ns, nj.y, ts * tj.y),
          fused(ns, nj.spin, fused(ts, tj.spin, s.rolling * mi.ss * mj.ss))};
}

/// sum += k a
template <class V>
VOUSSOIR_LANES_INLINE void add_product(const CouplingBlock<V>& k, const GrainDofs<V>& a, GrainDofs<V>& sum) {
  sum.x = fused(k.xx, a.x, fused(k.xy, a.y, fused(k.xs, a.spin, sum.x)));
  sum.y = fused(k.yx, a.x, fused(k.yy, a.y, fused(k.ys, a.spin, sum.y)));
  sum.spin = fused(k.sx, a.x, fused(k.sy, a.y, fused(k.ss, a.spin, sum.spin)));
}

/// sum += k^T a
template <class V>
VOUSSOIR_LANES_INLINE void add_transposed(const CouplingBlock<V>& k, const GrainDofs<V>& a, GrainDofs<V>& sum) {
  sum.x = fused(k.xx, a.x, fused(k.yx, a.y, fused(k.sx, a.spin, sum.x)));
  sum.y = fused(k.xy, a.x, fused(k.yy, a.y, fused(k.sy, a.spin, sum.y)));
  sum.spin = fused(k.xs, a.x, fused(k.ys, a.y, fused(k.ss, a.spin, sum.spin)));
}

/// Lists for each grain the springs to grains of smaller numbers, in their order.
template <class V>
void list_above(SpringSystem<V>& system) {
  const std::size_t n = system.radii.size();
  system.column.assign(n + 1, 0);
  for (std::size_t c = 0; c < system.size(); ++c) ++system.column[static_cast<std::size_t>(system.shapes[c].other)];
  int end = 0;
  for (int& entry : system.column) {  // from the number of a grain's entries to their end; filling makes it their start
    end += entry;
    entry = end;
  }
  for (std::size_t i = n; i-- > 0;) {
    for (int c = system.row[i + 1]; c-- > system.row[i];) {
      const auto j = static_cast<std::size_t>(system.shapes[static_cast<std::size_t>(c)].other);
      system.above[static_cast<std::size_t>(--system.column[j])] = {static_cast<int>(i), c};
    }
  }
}

/// Substitutes forward: (I + L) x = from, with x written to `to`; both return StrainDofs of a grain.
/// @param use use(grain, x of the grain), in the order of the grains
template <class V, class From, class To, class Use>
VOUSSOIR_LANES_INLINE void substitute_forward(SpringSystem<V>& system, const From& from, const To& to, const Use& use) {
  SolverGrain<V>* const grains = system.grains.data();
  const CouplingBlock<V>* const blocks = system.blocks.data();
  const SpringAbove* const above = system.above.data();
  for (std::size_t i = 0; i < system.grains.size(); ++i) {
    StrainDofs<V> x = from(grains[i]);
    const auto end = static_cast<std::size_t>(system.column[i + 1]);
    for (auto k = static_cast<std::size_t>(system.column[i]); k < end; ++k) {
      const CouplingBlock<V>& block = blocks[above[k].spring];
      const StrainDofs<V>& other = to(grains[above[k].grain]);
      for (std::size_t a = 0; a < unit_strains; ++a) add_transposed(block, other[a], x[a]);
    }
    to(grains[i]) = x;
    use(grains[i], x);
  }
}

/// Substitutes backward: (I + L^T) image = direction. @param turn gives the direction of a grain
template <class V, class Turn>
VOUSSOIR_LANES_INLINE void substitute_backward(SpringSystem<V>& system, const Turn& turn) {
  SolverGrain<V>* const grains = system.grains.data();
  const CouplingBlock<V>* const blocks = system.blocks.data();
  const SpringShape<real_of<V>>* const shapes = system.shapes.data();
  for (std::size_t i = system.grains.size(); i-- > 0;) {
    StrainDofs<V> x = turn(grains[i]);
    const auto end = static_cast<std::size_t>(system.row[i + 1]);
    for (auto c = static_cast<std::size_t>(system.row[i]); c < end; ++c) {
      const StrainDofs<V>& other = grains[shapes[c].other].image;
      for (std::size_t a = 0; a < unit_strains; ++a) add_product(blocks[c], other[a], x[a]);
    }
    grains[i].image = x;
  }
}

/// Computes the blocks, the scaled residuals of grains that do not move by themselves under the unit strains, and twice
/// the energies of this affine motion. @param diagonal whether `inverse_diagonal` is wanted
template <class V>
void load_springs(SpringSystem<V>& system, bool diagonal, PerStrain<V>& energy) {
  const V zero(0);
  const GrainDofs<V> none{zero, zero, zero};
  for (SolverGrain<V>& g : system.grains) {
    g.motion = g.residual = {none, none, none};
    g.scale = {zero, zero, zero, zero, zero, zero};
  }
  for_each_spring(system, [&](std::size_t c, SolverGrain<V>& gi, SolverGrain<V>& gj, const V& ri, const V& rj) {
    const SpringLanes<V>& s = system.springs[c];
    add_block(s, ri, gi.scale);
    add_block(s, -rj, gj.scale);
    for (std::size_t a = 0; a < unit_strains; ++a) {
      V dx = zero, dy = zero;
      add_unit_strain(static_cast<int>(a), s, dx, dy);
      const SpringStrain<V> e = spring_strain(s, dx, dy, ri, zero, rj, zero);
      pull(s, force_of(s, e), ri, rj, gi.residual[a], gj.residual[a]);
      energy[a] = fused(s.normal * e.normal, e.normal, fused(s.tangential * e.sliding, e.sliding, energy[a]));
    }
  });
  for (SolverGrain<V>& g : system.grains) {
    if (diagonal) {
      g.inverse_diagonal = {inverse_or_zero(g.scale.xx), inverse_or_zero(g.scale.yy), inverse_or_zero(g.scale.ss)};
    }
    g.scale = scale_of(g.scale);
    for (GrainDofs<V>& r : g.residual) r = scaled(g.scale, r);
  }
  for_each_spring(system, [&](std::size_t c, SolverGrain<V>& gi, SolverGrain<V>& gj, const V& ri, const V& rj) {
    system.blocks[c] = coupling(system.springs[c], ri, rj, gi.scale, gj.scale);
  });
  list_above(system);
}

}  // namespace voussoir::kernels
