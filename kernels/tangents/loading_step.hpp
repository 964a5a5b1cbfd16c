#pragma once
/// A small step of strain on the contacts at rest, with the law's caps: the changes of the forces and the slopes of
/// these changes.
///
/// The geometry is linear, the law (its function `step`) is not: a force that would pass its cap follows the cap
/// instead, mu f_n or arm f_n, and a contact that opens loses its forces. The forces that a contact carries already
/// turn with it. All motions and forces are divided by the strain of the step, so that they have the size of those in
/// static_tangent.hpp.

#include "kernels/tangents/contact_springs.hpp"

namespace voussoir::kernels {

/// Slopes of a contact's forces by its changes of length, at its state in the step. Forces at their caps follow the
/// closing of the contact.
template <class V>
struct StepSlope {
  V normal, shear, moment, shear_by_closing, moment_by_closing;  ///< k_n, k_t / y [N/m], k_r [N m/rad], [N/m], [N]
};

template <class V>
struct StepSpring {
  V turned_x, turned_y;                          ///< carried force on i, turned by a right angle, over |b| [N/m]
  std::array<StepSlope<V>, unit_strains> slope;  ///< at the last take_step
};

/// Working arrays of one grain in the biconjugate gradients, in addition to those of SolverGrain.
template <class V>
struct StepGrain {
  StrainDofs<V> shadow, half, half_image;
};

/// The arrays that a step needs besides a SpringSystem. Reused from group to group; empty unless a loading tangent is
/// asked for.
template <class V>
struct StepSystem {
  PerStrain<V> size;  ///< signed strain of each column's step [-]
  std::vector<StepSpring<V>> springs;
  std::vector<StepGrain<V>> grains;
};

/// Change of sum P (x) b by unit strain: xx, yy, xy (symmetrised) [N m]. It leaves out the part that comes from the
/// change of volume.
template <class V>
using StressChange = std::array<std::array<V, 3>, unit_strains>;

template <class V>
VOUSSOIR_LANES_INLINE SpringForce<V> force_of(const StepSlope<V>& k, const SpringStrain<V>& e) {
  return {k.normal * e.normal, fused(k.shear, e.sliding, -(k.shear_by_closing * e.normal)),
          fused(k.moment, e.rolling, -(k.moment_by_closing * e.normal))};
}

/// Does what `pull` does, and turns the carried force with the contact. Returns the change of the force on i.
template <class V>
VOUSSOIR_LANES_INLINE GrainDofs<V> pull_and_turn(const SpringLanes<V>& s, const StepSpring<V>& carried,
                                                 const SpringForce<V>& f, const V& across, const V& radius_i,
                                                 const V& radius_j, GrainDofs<V>& on_i, GrainDofs<V>& on_j) {
  const GrainDofs<V> change = pull(s, f, radius_i, radius_j, on_i, on_j);
  const V tx = across * carried.turned_x, ty = across * carried.turned_y;
  on_i.x = on_i.x + tx;
  on_i.y = on_i.y + ty;
  on_j.x = on_j.x - tx;
  on_j.y = on_j.y - ty;
  return {change.x + tx, change.y + ty, change.spin};
}

/// f_t of a contact at rest. @param ratio R/|b|; @param history within the caps
template <class Law, class V>
VOUSSOIR_LANES_INLINE V carried_tangential(const Law& law, const V& overlap, const V& ratio,
                                           typename Law::History history) {
  return law({overlap, overlap * ratio, V(0), V(0)}, history).tangential;
}

/// Sets the sizes of the arrays and the forces that contacts carry; to be called after collect_springs.
template <class Law, class V>
void prepare_step(const GroupState<Law>& group, const SpringSystem<V>& system, StepSystem<V>& step) {
  step.springs.resize(system.size());
  step.grains.resize(system.grains.size());
  for (std::size_t c = 0; c < system.size(); ++c) {
    const SpringLanes<V>& s = system.springs[c];
    const auto p = static_cast<std::size_t>(system.shapes[c].pair);
    const V& overlap = system.overlaps[c];
    const Law law(group.pair_shapes[p].law);
    const V fn = law.secant(overlap) * overlap * s.ratio;  // both forces over |b|
    const V ft = carried_tangential(law, overlap, s.ratio, group.pairs[p].history) / s.branch;
    step.springs[c].turned_x = fused(fn, s.normal_y, -(ft * s.normal_x));
    step.springs[c].turned_y = -fused(fn, s.normal_x, ft * s.normal_y);
  }
}

/// The law's forces for contact c under strain `e` of column `a`, divided by the strain of the step. Their slopes are
/// kept in `step`.
template <class Law, class V>
VOUSSOIR_LANES_INLINE SpringForce<V> answer(const GroupState<Law>& group, const SpringSystem<V>& system,
                                            StepSystem<V>& step, std::size_t c, std::size_t a,
                                            const SpringStrain<V>& e) {
  const auto p = static_cast<std::size_t>(system.shapes[c].pair);
  const V& size = step.size[a];
  const V over_size = V(1) / size, over_ratio = V(1) / system.springs[c].ratio;
  const V over_sum(group.pair_shapes[p].inverse_sum);
  const ContactStep<V> now = Law(group.pair_shapes[p].law)
                                 .step(system.overlaps[c], group.pairs[p].history, -(size * e.normal * over_sum),
                                       size * e.sliding, size * e.rolling);
  step.springs[c].slope[a] = {now.normal_stiffness, now.tangential.slope * over_ratio, now.moment.slope,
                              now.tangential.by_closing * over_ratio * over_sum, now.moment.by_closing * over_sum};
  const V fn = now.normal_change / over_sum;
  return {-(fn * over_size), now.tangential.change * over_ratio * over_size, now.moment.change * over_size};
}

/// Adds a contact's part of the change of the stress. @param force change of the force on i; @param dx, dy displacement
/// of the branch's far end
template <class V>
VOUSSOIR_LANES_INLINE void add_change(const SpringLanes<V>& s, const StepSpring<V>& carried, const GrainDofs<V>& force,
                                      const V& dx, const V& dy, std::array<V, 3>& sum) {
  const V bx = s.branch * s.normal_x, by = s.branch * s.normal_y, half(real_of<V>(0.5));
  const V px = s.branch * carried.turned_y, py = -(s.branch * carried.turned_x);
  sum[0] = fused(force.x, bx, fused(px, dx, sum[0]));
  sum[1] = fused(force.y, by, fused(py, dy, sum[1]));
  sum[2] = fused(half, fused(force.x, by, fused(force.y, bx, fused(px, dy, py * dx))), sum[2]);
}

/// Computes the residual forces on the grains at their present motions, the slopes of the contacts at these motions,
/// and the change of the stress.
template <class Law, class V>
void take_step(const GroupState<Law>& group, SpringSystem<V>& system, StepSystem<V>& step, StressChange<V>& change) {
  const V zero(0);
  const GrainDofs<V> none{zero, zero, zero};
  for (SolverGrain<V>& g : system.grains) g.residual = {none, none, none};
  change.fill({zero, zero, zero});
  for_each_spring(system, [&](std::size_t c, SolverGrain<V>& gi, SolverGrain<V>& gj, const V& ri, const V& rj) {
    const SpringLanes<V>& s = system.springs[c];
    for (std::size_t a = 0; a < unit_strains; ++a) {
      V dx, dy;
      const SpringStrain<V> e = strain_of(s, a, gi, gj, ri, rj, dx, dy);
      const SpringForce<V> f = answer(group, system, step, c, a, e);
      const GrainDofs<V> on_i = pull_and_turn(s, step.springs[c], f, e.across, ri, rj, gi.residual[a], gj.residual[a]);
      add_change(s, step.springs[c], on_i, dx, dy, change[a]);
    }
  });
}

/// The action of the contacts by their slopes at the last take_step, for `respond`.
template <class V>
struct SlopesAct {
  const SpringSystem<V>& system;
  const StepSystem<V>& step;

  VOUSSOIR_LANES_INLINE void operator()(std::size_t c, std::size_t a, const SpringStrain<V>& e, const V& radius_i,
                                        const V& radius_j, GrainDofs<V>& on_i, GrainDofs<V>& on_j) const {
    const StepSpring<V>& now = step.springs[c];
    pull_and_turn(system.springs[c], now, force_of(now.slope[a], e), e.across, radius_i, radius_j, on_i, on_j);
  }
};

}  // namespace voussoir::kernels
