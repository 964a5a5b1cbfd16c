#pragma once
/// One step of one pair and of one grain, in displacements since the list was made: the physics of kernels/contact with
/// one class of grains and the linear law. A pair's constants are computed from radii here instead of being loaded.

#include "tests/benchmark/gpu_step/real.hpp"

namespace voussoir::gpu_step {

/// The cell's motion of one step, as all threads read it.
template <class Real>
struct Motion {
  Real f_xx, f_xy, f_yx, f_yy;  ///< F - I since the list was made
  Real d_xy, d_diff;            ///< the cell's shear over the step, and the difference of its two stretches
  Real e_xx, e_xy, e_yx, e_yy;  ///< how displacements grow with the cell over the step
  Real spin;                    ///< the cell's rotation over the step [rad]
  Real unused;                  ///< a multiple of 16 bytes is loaded faster
};

/// Constants that all grains share. Times are in steps, so that a velocity is a displacement a step [m].
template <class Real>
struct Material {
  Real modulus2;         ///< 2 E [Pa]: k_n = 2 E r_i r_j / (r_i + r_j) [N/m]
  Real stiffness_ratio;  ///< k_t / k_n
  Real rolling;          ///< beta: k_r = beta k_t r_i r_j
  Real friction;         ///< tan of the friction angle
  Real rolling_limit;    ///< eta: the moment's cap over min(r_i, r_j) f_n
  Real mobility;         ///< dt^2 r / m [m^2/N]
  Real spin_mobility;    ///< dt^2 r^3 / (moment of inertia) [m^2/N]
  Real damping;          ///< local damping, 0 to 1
};

/// What one RVE keeps in shared memory for its steps.
template <class Real>
struct Shared {
  Quad<Real>* grain;       ///< (grains): displacement u_x, u_y [m]; fluctuation w_x, w_y [m a step]
  Two<Real>* spin_radius;  ///< (grains): rotation a step [rad], radius [m]
  Quad<Real>* action;      ///< (capacity + 1): force on i [N], moment on i, moment on j [N m]; the last stays zero
  std::uint16_t* row;      ///< where grain i's indices begin, by Gather (step.hpp)
  std::uint16_t* incoming_row;
  std::uint16_t* indices;
};

/// A pair as its thread keeps it in registers.
template <class Real>
struct Pair {
  Real branch_x, branch_y, gap;  ///< b0 [m], g0 [m^2]
  Real tangential, moment;       ///< histories [N], [N m]
  std::uint32_t grains;          ///< i << 16 | j
};

/// f (x) l of a pair [N m], for the mean stress.
template <class Real>
struct Stress {
  Real xx, xy, yx, yy;
};

/// (R/|b| - 1) / e, with e = 1 - |b|^2 / R^2: the polynomials of kernels/lanes/sweep.hpp.
template <class Real>
VOUSSOIR_DEVICE Real excess_over(Real e) {
  const Real e2 = e * e, e4 = e2 * e2, p0 = fused(Real(0.375), e, Real(0.5));
  if constexpr (sizeof(Real) == 4) {
    const Real p2 = fused(Real(0.273604941), e, Real(0.312499764));
    const Real p4 = fused(Real(0.338042773), e, Real(0.236938801));
    const Real p6 = fused(Real(0.97745921), e, Real(-0.282095656));
    return fused(fused(p6, e2, p4), e4, fused(p2, e2, p0));
  } else {
    const Real p2 = fused(Real(0.2734375), e, Real(0.3125));
    const Real p4 = fused(Real(0.2255849802289785), e, Real(0.246093750790672));
    const Real p6 = fused(Real(0.1864639065391075), e, Real(0.209713862168221));
    const Real p8 = fused(Real(0.8810090424314304), e2, fused(Real(-0.2865442362287911), e, Real(0.2963936109142559)));
    return fused(fused(p8, e2, p6), e4 * e2, fused(fused(p4, e2, p2), e2, p0));
  }
}

/// The branch x_j - x_i of a pair now [m].
template <class Real>
VOUSSOIR_DEVICE Two<Real> branch_change(const Quad<Real>& a, const Quad<Real>& b, Real bx, Real by,
                                        const Motion<Real>& c) {
  return {fused(c.f_xx, bx, fused(c.f_xy, by, b.x - a.x)), fused(c.f_yx, bx, fused(c.f_yy, by, b.y - a.y))};
}

template <class Real>
VOUSSOIR_DEVICE Stress<Real> stress_of(const Quad<Real>& action, Real x, Real y) {
  return {action.x * x, action.x * y, action.y * x, action.y * y};
}

/// Forces of pair `p`: its histories go on, its action goes to shared memory; its share of the stress is returned.
/// @tparam rolling whether grains resist rolling; @tparam branch whether pairs that do not touch skip the forces (else
/// they compute zeros, and no warp waits for its few touching pairs)
template <bool rolling, bool branch, class Real>
VOUSSOIR_DEVICE Stress<Real> pair_step(const Shared<Real>& s, Pair<Real>& pair, int p, const Motion<Real>& c,
                                       const Material<Real>& of) {
  const int i = static_cast<int>(pair.grains >> 16), j = static_cast<int>(pair.grains & 0xffffU);
  const Quad<Real> a = s.grain[i], b = s.grain[j];
  const Two<Real> d = branch_change(a, b, pair.branch_x, pair.branch_y, c);
  const Real gap = fused(d.x, fused(Real(2), pair.branch_x, d.x),
                         fused(d.y, fused(Real(2), pair.branch_y, d.y), pair.gap));
  const bool touches = gap < Real(0);
  Quad<Real> action{0, 0, 0, 0};
  Stress<Real> stress{0, 0, 0, 0};
  if (!branch || touches) {
    const Two<Real> si = s.spin_radius[i], sj = s.spin_radius[j];
    const Real x = pair.branch_x + d.x, y = pair.branch_y + d.y;
    const Real sum = si.y + sj.y, inverse = reciprocal(sum), product = si.y * sj.y;
    const Real of_gap = -gap * (inverse * inverse);
    const Real e = branch ? of_gap : (touches ? of_gap : Real(0));
    const Real z = e * excess_over(e), overlap = fused(e - Real(1), z, e), inverse_length = fused(z, inverse, inverse);
    const Real vx = fused(c.d_xy, y, b.z - a.z), vy = fused(c.d_xy, x, fused(c.d_diff, y, b.w - a.w));
    const Real across = fused(vy, x, -(vx * y));
    const Real slide = fused(fused(z, inverse_length, inverse_length), across, -fused(sj.y, sj.x, si.y * si.x));
    const Real kn_sum = of.modulus2 * product, kn = kn_sum * inverse, kt = of.stiffness_ratio * kn;
    const Real ft = pair.tangential = capped(fused(kt, slide, pair.tangential), of.friction * kn_sum * overlap);
    Real moment = 0;
    if (rolling) {
      const Real cap = of.rolling_limit * least(si.y, sj.y) * kn_sum * overlap;
      moment = pair.moment = capped(fused(of.rolling * kt * product, sj.x - si.x, pair.moment), cap);
    }
    const Real half = Real(-0.5) * sum, fn = kn * z, as = ft * inverse_length;
    action.x = -fused(as, y, fn * x);
    action.y = fused(as, x, -(fn * y));
    action.z = fused(fused(half, overlap, si.y), ft, moment);
    action.w = fused(fused(half, overlap, sj.y), ft, -moment);
    stress = stress_of(action, x, y);
  } else {
    pair.tangential = pair.moment = Real(0);
  }
  s.action[p] = action;
  return stress;
}

/// Force [N] and moment [N m] on a grain.
template <class Real>
struct Load {
  Real x = 0, y = 0, moment = 0;

  /// @param incoming whether the grain is the pair's second one
  VOUSSOIR_DEVICE void add(const Quad<Real>& from, bool incoming) {
    // The copy makes nvcc load the action whole. Without it only the moment that is needed was loaded, by an
    // instruction of its own, and a step with one list took 1.14 times as long.
    const Quad<Real> action = from;
    x += incoming ? -action.x : action.x;
    y += incoming ? -action.y : action.y;
    moment += incoming ? action.w : action.z;
  }
};

/// A velocity after a step of local damping.
template <class Real>
VOUSSOIR_DEVICE Real kicked(Real w, Real force, Real mobility, Real damping) {
  const Real middle = fused(Real(0.5) * mobility, force, w);
  return fused(mobility, force - std::copysign(damping * force, middle), w);
}

/// Grain i moves by its load. The sum of its squared force is returned [N^2].
template <class Real>
VOUSSOIR_DEVICE Real move_grain(const Shared<Real>& s, int i, Real& rotation, const Load<Real>& load,
                                const Motion<Real>& c, const Material<Real>& of) {
  Quad<Real> g = s.grain[i];
  Two<Real> q = s.spin_radius[i];
  const Real inverse = reciprocal(q.y), mobility = of.mobility * inverse;
  const Real spin_mobility = of.spin_mobility * inverse * inverse * inverse;
  // A grain without any contact loses its velocity, so that it does not fly.
  const Real kept = (load.x == Real(0) && load.y == Real(0) && load.moment == Real(0)) ? Real(0.9) : Real(1);
  const Real wx = kept * fused(-c.spin, g.w, kicked(g.z, load.x, mobility, of.damping));
  const Real wy = kept * fused(c.spin, g.z, kicked(g.w, load.y, mobility, of.damping));
  q.x = kept * kicked(q.x, load.moment, spin_mobility, of.damping);
  const Real ux = g.x, uy = g.y;
  g.x = ux + fused(c.e_xx, ux, fused(c.e_xy, uy, wx));
  g.y = uy + fused(c.e_yx, ux, fused(c.e_yy, uy, wy));
  g.z = wx;
  g.w = wy;
  rotation += q.x;
  s.grain[i] = g;
  s.spin_radius[i] = q;
  return fused(load.x, load.x, load.y * load.y);
}

/// The cell goes on by E: F - I <- E + (F - I) + E (F - I).
template <class Real>
VOUSSOIR_DEVICE void move_cell(Mat2& f, const Mat2& e, Motion<Real>& motion) {
  const Mat2 old = f;
  f = {e.xx + old.xx + (e.xx * old.xx + e.xy * old.yx), e.xy + old.xy + (e.xx * old.xy + e.xy * old.yy),
       e.yx + old.yx + (e.yx * old.xx + e.yy * old.yx), e.yy + old.yy + (e.yx * old.xy + e.yy * old.yy)};
  motion.f_xx = static_cast<Real>(f.xx);
  motion.f_xy = static_cast<Real>(f.xy);
  motion.f_yx = static_cast<Real>(f.yx);
  motion.f_yy = static_cast<Real>(f.yy);
}

}  // namespace voussoir::gpu_step
