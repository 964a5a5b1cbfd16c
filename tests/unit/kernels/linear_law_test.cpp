// The contact law along paths with a closed form, before any packing exists; and the same numbers in every lane type.
#include "kernels/contact/linear_law.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "kernels/lanes/wide_lane.hpp"

namespace voussoir::kernels {
namespace {

using lanes::WideLane;
using V = SingleLane<double>;
using Law = LinearContactLaw<V, true>;

constexpr double kn = 5e6, kt = 2.5e6, kr = 8.0, mu = 0.5, arm = 6e-4;
constexpr double delta = 2e-6;
constexpr double fn = kn * delta;        // 10 N
constexpr double cap = mu * fn;          // 5 N
constexpr double yield = cap / kt;       // 2 um: slip begins
constexpr double moment_cap = arm * fn;  // 6e-3 N m
constexpr double roll_yield = moment_cap / kr;

// R = |b| = 1 m: an overlap is the same number in every unit.
Law law() { return Law(Law::Pair{kn, kt, kr, mu * kn, arm * kn}); }
ContactMotion<V> motion(double overlap, double sliding, double rolling) {
  return {V(overlap), V(overlap), V(sliding), V(rolling)};
}

/// Sums increments of 1/1000 of the path, as the engine would.
ContactForce<V> slide_by(Law::History& history, double total) {
  ContactForce<V> force{};
  for (int k = 0; k < 1000; ++k) force = law()(motion(delta, total / 1000, 0), history);
  return force;
}

ContactForce<V> roll_by(Law::History& history, double total) {
  ContactForce<V> force{};
  for (int k = 0; k < 1000; ++k) force = law()(motion(delta, 0, total / 1000), history);
  return force;
}

constexpr double rounding = 2e-12;  // 1000 sums in double

TEST(ContactLaw, NormalForceIsLinear) {
  Law::History history{V(0), V(0)};
  EXPECT_EQ(law()(motion(delta, 0, 0), history).normal_to_branch[0], fn);
  EXPECT_EQ(law()(motion(3 * delta, 0, 0), history).normal_to_branch[0], kn * (3 * delta));
  EXPECT_EQ(law()(motion(0, 0, 0), history).normal_to_branch[0], 0.0);
}

TEST(ContactLaw, LoadSlideUnloadReverse) {
  Law::History history{V(0), V(0)};
  EXPECT_NEAR(slide_by(history, 0.6 * yield).tangential[0], 0.6 * cap, rounding);   // elastic
  EXPECT_NEAR(slide_by(history, 2.0 * yield).tangential[0], cap, rounding);         // slides at the cap
  EXPECT_NEAR(slide_by(history, -0.5 * yield).tangential[0], 0.5 * cap, rounding);  // unloads at once, elastically
  EXPECT_NEAR(slide_by(history, -1.0 * yield).tangential[0], -0.5 * cap, rounding);
  EXPECT_NEAR(slide_by(history, -3.0 * yield).tangential[0], -cap, rounding);  // slides the other way
  EXPECT_NEAR(slide_by(history, 0.5 * yield).tangential[0], -0.5 * cap, rounding);
  EXPECT_NEAR(history.tangential[0], -0.5 * cap, rounding);
  EXPECT_EQ(history.moment[0], 0.0);
}

TEST(ContactLaw, SlidingDissipatesItsClosedFormWork) {
  // One full cycle of amplitude A > yield encloses 4 cap (A - yield).
  Law::History history{V(0), V(0)};
  const double amplitude = 3 * yield;
  slide_by(history, amplitude);
  double work = 0;
  const int n = 20000;
  for (const double sign : {-1.0, 1.0}) {
    for (int k = 0; k < n; ++k) {
      const double before = history.tangential[0];
      const double increment = sign * 2 * amplitude / n;
      law()(motion(delta, increment, 0), history);
      work += 0.5 * (before + history.tangential[0]) * increment;
    }
  }
  const double closed = 4 * cap * (amplitude - yield);
  EXPECT_NEAR(work, closed, 1e-7 * closed);  // the trapezoid over the kink: 2.5e-9 was measured
}

TEST(ContactLaw, CoulombCapFollowsTheNormalForce) {
  Law::History history{V(0), V(0)};
  slide_by(history, 0.9 * yield);
  EXPECT_NEAR(law()(motion(delta / 2, 0, 0), history).tangential[0], 0.5 * cap, rounding);  // unloading cuts it
  EXPECT_NEAR(law()(motion(delta, 0, 0), history).tangential[0], 0.5 * cap, rounding);      // and nothing restores it
  EXPECT_NEAR(law()(motion(10 * delta, 3 * yield, 0), history).tangential[0], 3.5 * cap, rounding);
}

TEST(ContactLaw, SeparationForgets) {
  Law::History history{V(0), V(0)};
  slide_by(history, 0.9 * yield);
  roll_by(history, 0.9 * roll_yield);
  const ContactForce<V> open = law()(motion(0, yield, roll_yield), history);
  EXPECT_EQ(open.normal_to_branch[0], 0.0);
  EXPECT_EQ(open.tangential[0], 0.0);
  EXPECT_EQ(open.moment[0], 0.0);
  EXPECT_EQ(history.tangential[0], 0.0);
  EXPECT_EQ(history.moment[0], 0.0);
  EXPECT_EQ(law()(motion(delta, 0, 0), history).tangential[0], 0.0);  // a new contact starts from nothing
}

TEST(ContactLaw, RollingSpringWithPlasticCap) {
  Law::History history{V(0), V(0)};
  EXPECT_NEAR(roll_by(history, 0.7 * roll_yield).moment[0], 0.7 * moment_cap, rounding * moment_cap);
  EXPECT_NEAR(roll_by(history, 5.0 * roll_yield).moment[0], moment_cap, rounding * moment_cap);
  EXPECT_NEAR(roll_by(history, -1.5 * roll_yield).moment[0], -0.5 * moment_cap, rounding * moment_cap);
  EXPECT_NEAR(roll_by(history, -5.0 * roll_yield).moment[0], -moment_cap, rounding * moment_cap);
  EXPECT_NEAR(law()(motion(delta / 4, 0, 0), history).moment[0], -0.25 * moment_cap, rounding * moment_cap);
  EXPECT_EQ(history.tangential[0], 0.0);
}

TEST(ContactLaw, WithoutRollingNoMomentAndTheSameShear) {
  const LinearContactLaw<V, false> plain({kn, kt, kr, mu * kn, arm * kn});
  LinearContactLaw<V, false>::History plain_history{V(1), V(7e-3)};
  Law::History history{V(1), V(0)};
  const ContactForce<V> f = plain(motion(delta, 0.3 * yield, 0.5 * roll_yield), plain_history);
  EXPECT_EQ(f.moment[0], 0.0);
  EXPECT_EQ(plain_history.moment[0], 7e-3);
  EXPECT_EQ(f.tangential[0], law()(motion(delta, 0.3 * yield, 0.5 * roll_yield), history).tangential[0]);
}

TEST(ContactLaw, ARepeatedCallWithoutMotionChangesNothing) {
  Law::History history{V(0), V(0)};
  slide_by(history, 0.7 * yield);
  roll_by(history, 3 * roll_yield);
  const Law::History before = history;
  law()(motion(delta, 0, 0), history);
  EXPECT_EQ(history.tangential[0], before.tangential[0]);
  EXPECT_EQ(history.moment[0], before.moment[0]);
}

TEST(Combination, EqualGrains) {
  const GrainMaterial sand;
  const PairConstants c = combine(sand, 1e-3, sand, 1e-3);
  EXPECT_NEAR(c.normal_stiffness, 3e6, 1e-6);  // E r
  EXPECT_NEAR(c.tangential_stiffness, 1.5e6, 1e-6);
  EXPECT_NEAR(c.rolling_stiffness, 1.5, 1e-12);  // beta k_t r^2
  EXPECT_EQ(c.friction, sand.friction);
  EXPECT_NEAR(c.rolling_arm, 6e-4, 1e-18);
}

TEST(Combination, TwoClassesByHand) {
  // Table 1: coarse gravel (r = 10 mm) on coarse sand (r = 1 mm).
  const GrainMaterial gravel{.modulus = 5e9,
                             .stiffness_ratio = 0.8,
                             .friction = std::tan(50 * 3.141592653589793 / 180),
                             .rolling_stiffness = 1,
                             .rolling_limit = 0.8};
  const GrainMaterial sand;
  const PairConstants c = combine(gravel, 1e-2, sand, 1e-3);
  EXPECT_NEAR(c.normal_stiffness, 2 * 50e6 * 3e6 / 53e6, 1e-8);
  EXPECT_NEAR(c.tangential_stiffness, 2 * 40e6 * 1.5e6 / 41.5e6, 1e-6);  // its own series, not 0.65 k_n
  EXPECT_NEAR(c.rolling_stiffness, c.tangential_stiffness * 1e-5, 1e-9);
  EXPECT_EQ(c.friction, sand.friction);
  EXPECT_NEAR(c.rolling_arm, 6e-4, 1e-18);  // min(0.8 * 10, 0.6 * 1) mm
  const PairConstants swapped = combine(sand, 1e-3, gravel, 1e-2);
  EXPECT_EQ(c.normal_stiffness, swapped.normal_stiffness);
  EXPECT_EQ(c.tangential_stiffness, swapped.tangential_stiffness);
  EXPECT_EQ(c.rolling_arm, swapped.rolling_arm);
  EXPECT_EQ(c.friction, swapped.friction);
}

/// The caps of a pair's springs follow the overlap over R = r1 + r2, so that they are mu and the arm times f_n.
TEST(Combination, CapsAreOfTheSumOfTheRadii) {
  const GrainMaterial sand;
  const GrainMaterial gravel{.modulus = 5e9, .friction = 1.2, .rolling_limit = 0.8};
  struct Expected {
    GrainMaterial first, second;
    double r1, r2, normal_stiffness, arm;
  };
  const Expected pairs[] = {{sand, sand, 1e-3, 1e-3, 3e6, 6e-4},
                            {gravel, sand, 1e-2, 1e-3, 2 * 50e6 * 3e6 / 53e6, 6e-4},
                            {sand, gravel, 1e-3, 1e-2, 2 * 50e6 * 3e6 / 53e6, 6e-4}};
  for (const Expected& e : pairs) {
    const Law::Pair pair = Law::combine(e.first, e.r1, e.second, e.r2);
    const double sum = e.r1 + e.r2;
    EXPECT_DOUBLE_EQ(pair.tangential_cap, sand.friction * e.normal_stiffness * sum);
    EXPECT_DOUBLE_EQ(pair.moment_cap, e.arm * e.normal_stiffness * sum);
    // Far beyond both caps, at an overlap of a hundredth of R: mu f_n, and the arm times f_n.
    const double branch = 0.99 * sum, force = e.normal_stiffness * 0.01 * sum;
    Law::History history{V(0), V(0)};
    const ContactForce<V> f = Law(pair)({V(0.01), V(0.01 * sum / branch), V(1.0), V(10.0)}, history);
    EXPECT_DOUBLE_EQ(f.normal_to_branch[0] * branch, force);
    EXPECT_DOUBLE_EQ(f.tangential[0], sand.friction * force);
    EXPECT_DOUBLE_EQ(f.moment[0], e.arm * force);
  }
}

TEST(Combination, TheSmallestArmIsNotAlwaysTheSmallestGrain) {
  const GrainMaterial slick{.rolling_limit = 0.1};
  EXPECT_NEAR(combine(slick, 2e-3, GrainMaterial{}, 1e-3).rolling_arm, 2e-4, 1e-18);
}

/// Drives one contact through a jagged path of overlaps (open at times), slides and rolls; lane l sees it scaled by 1 +
/// l/7.
template <class Lane>
std::vector<std::array<real_of<Lane>, 3>> jagged_path(int lane_offset) {
  using real = real_of<Lane>;
  const LinearContactLaw<Lane, true> rule({real(kn), real(kt), real(kr), real(mu * kn), real(arm * kn)});
  typename LinearContactLaw<Lane, true>::History history{Lane(real(0)), Lane(real(0))};
  std::vector<std::array<real, 3>> out;
  for (int k = 0; k < 400; ++k) {
    ContactMotion<Lane> m{Lane(real(0)), Lane(real(0)), Lane(real(0)), Lane(real(0))};
    for (std::size_t l = 0; l < Lane::size(); ++l) {
      const double scale = 1 + (lane_offset + static_cast<double>(l)) / 7;
      m.overlap[l] = m.overlap_to_branch[l] = static_cast<real>(delta *
                                                                std::max(0.0, 0.7 + std::sin(0.05 * k * scale)));
      m.sliding[l] = static_cast<real>(0.4 * yield * std::cos(0.3 * k) * scale);
      m.rolling[l] = static_cast<real>(0.4 * roll_yield * std::sin(0.21 * k) * scale);
    }
    const ContactForce<Lane> f = rule(m, history);
    for (std::size_t l = 0; l < Lane::size(); ++l) out.push_back({f.normal_to_branch[l], f.tangential[l], f.moment[l]});
  }
  return out;
}

template <class real>
void check_lanes_against_scalar() {
  constexpr int width = lane_count<WideLane<real>>;
  const auto wide = jagged_path<WideLane<real>>(0);
  int slid = 0, open = 0;
  for (int l = 0; l < width; ++l) {
    const auto single = jagged_path<SingleLane<real>>(l);
    for (std::size_t k = 0; k < single.size(); ++k) {
      ASSERT_EQ(wide[k * width + l], single[k]) << "lane " << l << " call " << k;
      slid += std::abs(std::abs(single[k][1]) - real(mu) * single[k][0]) == 0 && single[k][0] > 0;
      open += single[k][0] == 0;
    }
  }
  EXPECT_GT(slid, 10);  // the path visits sliding and open contacts
  EXPECT_GT(open, 10);
}

/// A contact at rest at its share of the caps, and a small motion: every state from stuck to open.
struct Nudge {
  double overlap, tangential, moment;
  ContactMotion<V> by;
};
std::vector<Nudge> nudges() {
  std::vector<Nudge> out;
  for (int k = 0; k < 2000; ++k) {
    const double overlap = k % 7 == 0 ? 0.0 : delta * (1.2 + std::sin(0.9 * k));
    const double size = std::pow(10.0, -4 + 5.0 * (k % 11) / 10);  // of the overlap: some open
    out.push_back({overlap, mu * kn * overlap * std::sin(1.7 * k), arm * kn * overlap * std::cos(2.3 * k),
                   motion(size * delta * std::sin(3.1 * k), size * yield * std::cos(4.3 * k),
                          size * roll_yield * std::sin(5.9 * k))});
  }
  return out;
}

// The step's changes are what operator() adds to the forces it made before.
TEST(ContactLaw, StepIsTheChangeOfItsForces) {
  int stuck = 0, sliding = 0, rolling = 0, open = 0;
  for (const Nudge& n : nudges()) {
    Law::History history{V(n.tangential), V(n.moment)};
    const ContactForce<V> before = law()(motion(n.overlap, 0, 0), history);
    const ContactStep<V> step = law().step(V(n.overlap), history, n.by.overlap, n.by.sliding, n.by.rolling);
    const double after = n.overlap > 0 ? std::max(0.0, n.overlap + n.by.overlap[0]) : 0.0;  // no new contact
    const ContactForce<V> f = law()({V(after), V(after), n.by.sliding, n.by.rolling}, history);
    EXPECT_NEAR(step.normal_change[0], f.normal_to_branch[0] - before.normal_to_branch[0], 1e-14 * fn);
    EXPECT_NEAR(step.tangential.change[0], f.tangential[0] - before.tangential[0], 1e-14 * fn);
    EXPECT_NEAR(step.moment.change[0], f.moment[0] - before.moment[0], 1e-14 * arm * fn);
    open += after == 0 ? 1 : 0;
    stuck += step.tangential.slope[0] != 0 && step.moment.slope[0] != 0 ? 1 : 0;
    sliding += step.tangential.by_closing[0] != 0 ? 1 : 0;
    rolling += step.moment.by_closing[0] != 0 ? 1 : 0;
  }
  EXPECT_GT(std::min({stuck, sliding, rolling, open}), 100);
}

// Piecewise linear: differences over a thousandth of the motion are the slopes, but across a corner.
TEST(ContactLaw, StepHasTheSlopesOfItsChange) {
  int corners = 0, compared = 0;
  for (const Nudge& n : nudges()) {
    const Law::History history{V(n.tangential), V(n.moment)};
    const auto at = [&](double overlap, double sliding, double rolling) {
      return law().step(V(n.overlap), history, n.by.overlap + V(overlap), n.by.sliding + V(sliding),
                        n.by.rolling + V(rolling));
    };
    const double d = 1e-3 * delta, s = 1e-3 * yield, r = 1e-3 * roll_yield;
    const ContactStep<V> here = at(0, 0, 0), closed = at(d, 0, 0), slid = at(0, s, 0), rolled = at(0, 0, r);
    const auto same = [&](const ContactStep<V>& there) {
      return there.normal_stiffness[0] == here.normal_stiffness[0] &&
             there.tangential.slope[0] == here.tangential.slope[0] &&
             there.tangential.by_closing[0] == here.tangential.by_closing[0] &&
             there.moment.slope[0] == here.moment.slope[0] && there.moment.by_closing[0] == here.moment.by_closing[0];
    };
    if (!same(closed) || !same(slid) || !same(rolled)) {
      ++corners;
      continue;
    }
    ++compared;
    EXPECT_NEAR((closed.normal_change[0] - here.normal_change[0]) / d, here.normal_stiffness[0], 1e-11 * kn);
    EXPECT_NEAR((closed.tangential.change[0] - here.tangential.change[0]) / d, here.tangential.by_closing[0],
                1e-11 * kn);
    EXPECT_NEAR((closed.moment.change[0] - here.moment.change[0]) / d, here.moment.by_closing[0], 1e-11 * arm * kn);
    EXPECT_NEAR((slid.tangential.change[0] - here.tangential.change[0]) / s, here.tangential.slope[0], 1e-11 * kt);
    EXPECT_NEAR((rolled.moment.change[0] - here.moment.change[0]) / r, here.moment.slope[0], 1e-11 * kr);
  }
  EXPECT_LT(corners, compared / 10);
}

TEST(ContactLawLanes, WideDoubleIsBitIdenticalToScalar) { check_lanes_against_scalar<double>(); }
TEST(ContactLawLanes, WideFloatIsBitIdenticalToScalar) { check_lanes_against_scalar<float>(); }

TEST(ContactLawLanes, FloatFollowsDouble) {
  const auto single = jagged_path<SingleLane<float>>(0);
  const auto reference = jagged_path<SingleLane<double>>(0);
  for (std::size_t k = 0; k < single.size(); ++k) {
    EXPECT_NEAR(static_cast<double>(single[k][1]), reference[k][1], 3e-6 * cap);  // some 100 sums of 6e-8 each
    EXPECT_NEAR(static_cast<double>(single[k][2]), reference[k][2], 3e-6 * moment_cap);
  }
}

TEST(ContactLawLanes, ANotANumberStaysInItsLane) {
  using Lane = WideLane<double>;
  const LinearContactLaw<Lane, true> rule({kn, kt, kr, mu * kn, arm * kn});
  typename LinearContactLaw<Lane, true>::History history{Lane(0.0), Lane(0.0)};
  ContactMotion<Lane> m{Lane(delta), Lane(delta), Lane(0.5 * yield), Lane(0.5 * roll_yield)};
  m.sliding[0] = std::numeric_limits<double>::quiet_NaN();
  const ContactForce<Lane> f = rule(m, history);
  for (std::size_t l = 1; l < Lane::size(); ++l) {
    EXPECT_EQ(f.tangential[l], kt * (0.5 * yield));
    EXPECT_NEAR(f.moment[l], 0.5 * moment_cap, 1e-12 * moment_cap);
  }
}

}  // namespace
}  // namespace voussoir::kernels
