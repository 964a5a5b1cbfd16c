// The oracle's pair of grains against hand values: what the engine is measured with must be right by itself.
#include "tests/reference/reference_rve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "tests/reference/reference_packing.hpp"

namespace voussoir::reference {
namespace {

// Hand values of the pair used below: r = 2 and 3 mm, E = 3 GPa.
constexpr double ri = 2e-3, rj = 3e-3, overlap = 1e-6;
constexpr double kn = 7.2e6;  // 2 E ri rj/(ri + rj)
constexpr double kt = 3.6e6;  // kn/2
constexpr double kr = 21.6;   // beta kt ri rj
constexpr double fn = 7.2;    // kn overlap
constexpr double distance = ri + rj - overlap;

Material undamped() {
  Material material;
  material.damping = 0;
  return material;
}

Rve pair_along(double angle, const Material& material) { return two_grains(ri, rj, overlap, angle, 0.05, material); }

TEST(ReferencePair, NormalForceAndStress) {
  const double angle = 0.3;
  Rve rve = pair_along(angle, Material{});
  const auto found = contacts(rve);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].normal.x, std::cos(angle), 1e-13);
  EXPECT_NEAR(found[0].normal.y, std::sin(angle), 1e-13);
  EXPECT_NEAR(found[0].overlap, overlap, 1e-17);
  EXPECT_NEAR(found[0].normal_force, fn, 1e-11 * fn);  // overlap/r = 4e-4 costs 4 digits of 16
  const double c = std::cos(angle), s = std::sin(angle);
  const double scale = -fn * distance / (0.05 * 0.05 * 0.1);
  const Voigt sigma = stress(rve);
  EXPECT_NEAR(sigma[0], scale * c * c, 1e-11 * std::abs(scale));
  EXPECT_NEAR(sigma[1], scale * s * s, 1e-12 * std::abs(scale));
  EXPECT_NEAR(sigma[2], scale * c * s, 1e-11 * std::abs(scale));
  EXPECT_EQ(coordination_number(rve), 1.0);
}

TEST(ReferencePair, StressOfTangentialForceIsSymmetrised) {
  Rve rve = pair_along(0, Material{});
  rve.histories[{0, 1}] = {.tangential = 2.0, .moment = 0};
  const double scale = distance / (0.05 * 0.05 * 0.1);
  const Mat2 raw = love_weber(rve, contacts(rve));  // P = (-fn, ft), b = (distance, 0)
  EXPECT_NEAR(raw.yx, 2.0 * scale, 1e-13 * scale);
  EXPECT_EQ(raw.xy, 0.0);
  EXPECT_NEAR(stress(rve)[2], scale, 1e-13 * scale);
}

TEST(ReferencePair, TangentByHand) {
  const VoigtMatrix d = tangent(pair_along(0, Material{}));  // n = (1, 0), t = (0, 1)
  const double scale = distance * distance / (0.05 * 0.05 * 0.1);
  EXPECT_NEAR(d[0][0], kn * scale, 1e-13 * kn * scale);
  EXPECT_NEAR(d[2][2], 0.25 * kt * scale, 1e-13 * kt * scale);  // (t n + n t)/2 twice
  EXPECT_EQ(d[0][1], 0.0);
  EXPECT_EQ(d[1][1], 0.0);
  EXPECT_EQ(d[0][2], 0.0);
}

TEST(ReferencePair, ContactThroughThePeriodicBoundary) {
  Rve rve = pair_along(0.7, Material{});
  rve.cell = {0.05, 0.03, 0, 0.05};
  const Voigt before = stress(rve);
  rve.positions[1] = rve.positions[1] + Vec2{2 * 0.05 - 0.03, -0.05};
  const Voigt after = stress(rve);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(after[k], before[k], 1e-11 * std::abs(before[0]));
}

// In the next tests the motion is far smaller than the overlap, so that f_n and n change by less than the tolerance.
TEST(ReferencePair, TranslationShears) {
  Rve rve = pair_along(0, undamped());
  const double slide = 1e-9;
  rve.velocities = {{0, 0}, {0, slide}};
  rve.spins = {0, 0};
  step(rve, Mat2{}, Mat2{});
  const double y = (ri + rj) / distance;
  EXPECT_NEAR(rve.histories.at({0, 1}).tangential, kt * y * slide, 1e-12 * kt * slide);
  EXPECT_EQ(rve.histories.at({0, 1}).moment, 0.0);
}

TEST(ReferencePair, AffineMotionShearsAndRotationDoesNot) {
  Rve rve = pair_along(0, undamped());
  const double gamma = 2e-7;
  step(rve, Mat2{0, gamma, 0, 0}, Mat2{});  // D_yx = gamma/2, sliding y D b.t = (ri + rj) gamma/2
  EXPECT_NEAR(rve.histories.at({0, 1}).tangential, kt * (ri + rj) * 0.5 * gamma, 1e-13 * kt * (ri + rj) * gamma);
  Rve turned = pair_along(0.4, undamped());
  step(turned, Mat2{0, -1e-3, 1e-3, 0}, Mat2{});
  EXPECT_NEAR(turned.histories.at({0, 1}).tangential, 0.0, 1e-12 * fn);
  EXPECT_NEAR(contacts(turned)[0].normal_force, fn, 1e-10 * fn);
}

TEST(ReferencePair, EqualSpinsShearAndOppositeSpinsRoll) {
  const double spin = 1e-8;
  Rve sheared = pair_along(0.2, undamped());
  sheared.velocities = {{0, 0}, {0, 0}};
  sheared.spins = {spin, spin};
  step(sheared, Mat2{}, Mat2{});
  EXPECT_NEAR(sheared.histories.at({0, 1}).tangential, -kt * (ri + rj) * spin, 1e-13 * kt * (ri + rj) * spin);
  EXPECT_EQ(sheared.histories.at({0, 1}).moment, 0.0);

  Rve rolled = pair_along(0.2, undamped());
  rolled.velocities = {{0, 0}, {0, 0}};
  rolled.spins = {-spin / ri, spin / rj};  // r_i theta_i + r_j theta_j = 0: rolling without sliding
  step(rolled, Mat2{}, Mat2{});
  EXPECT_NEAR(rolled.histories.at({0, 1}).tangential, 0.0, 1e-12);
  const double moment = kr * spin * (1 / ri + 1 / rj);
  EXPECT_NEAR(rolled.histories.at({0, 1}).moment, moment, 1e-13 * moment);
}

TEST(ReferencePair, ForcesAndTorquesOnBothGrains) {
  Rve rve = pair_along(0, undamped());
  const double ft = 1.5, m = 2e-3;
  rve.histories[{0, 1}] = {.tangential = ft, .moment = m};
  step(rve, Mat2{}, Mat2{});
  const auto [ai, ari] = mobility(rve.material, ri, rj);
  const auto [aj, arj] = mobility(rve.material, rj, rj);
  EXPECT_NEAR(rve.velocities[0].x, -ai * fn, 1e-10 * ai * fn);
  EXPECT_NEAR(rve.velocities[0].y, ai * ft, 1e-13 * ai * fn);
  EXPECT_NEAR(rve.velocities[1].x, aj * fn, 1e-10 * aj * fn);
  EXPECT_NEAR(rve.velocities[1].y, -aj * ft, 1e-13 * aj * fn);
  EXPECT_NEAR(rve.spins[0], ari * ((ri - 0.5 * overlap) * ft + m), 1e-12 * ari * m);
  EXPECT_NEAR(rve.spins[1], arj * ((rj - 0.5 * overlap) * ft - m), 1e-13 * arj * m);
}

TEST(ReferencePair, MobilitiesByHand) {
  const auto [a, ar] = mobility(Material{}, 2e-3, 2e-3);  // k_n = 6e6, k_t = 3e6, beta = 1, c = 0.9
  EXPECT_NEAR(a, 0.81 * 4 / (36e6 + 36e6), 1e-20);
  EXPECT_NEAR(ar, 0.81 * 4 / ((72e6 + 36e6) * 4e-6), 1e-15);
  const double on_largest = 2 * 1.5e9 * 2e-3 * 40e-3 / 42e-3 * 2e-3 * 40e-3;  // on a grain of 20 times its size
  EXPECT_NEAR(mobility(Material{}, 2e-3, 40e-3).rotation, 0.81 * 4 / (72e6 * 4e-6 + 12 * on_largest), 1e-16);
}

TEST(ReferencePair, CoulombAndRollingCaps) {
  Rve rve = pair_along(0, undamped());
  rve.velocities = {{0, 0}, {0, -1e-6}};  // half the overlap: k_t s = 3.6 N, the cap is 0.466 f_n = 3.36 N
  rve.spins = {-1e-3 / ri, 1e-3 / rj};
  step(rve, Mat2{}, Mat2{});
  const double now = kn * (ri + rj - std::hypot(distance, 1e-6));
  EXPECT_NEAR(rve.histories.at({0, 1}).tangential, -0.466307658 * now, 1e-10 * fn);
  EXPECT_NEAR(rve.histories.at({0, 1}).moment, 0.6 * ri * now, 1e-10 * ri * fn);
}

TEST(ReferencePair, CapsFollowTheNormalForceAndSeparationForgets) {
  Rve rve = pair_along(0, undamped());
  rve.histories[{0, 1}] = {.tangential = 3.0, .moment = -5e-3};
  rve.velocities = {{0, 0}, {0.5e-6, 0}};  // f_n halves; both histories now exceed their caps
  rve.spins = {0, 0};
  step(rve, Mat2{}, Mat2{});
  EXPECT_NEAR(rve.histories.at({0, 1}).tangential, 0.466307658 * 0.5 * fn, 1e-10 * fn);
  EXPECT_NEAR(rve.histories.at({0, 1}).moment, -0.6 * ri * 0.5 * fn, 1e-10 * ri * fn);
  rve.velocities = {{0, 0}, {0.6e-6, 0}};
  step(rve, Mat2{}, Mat2{});
  EXPECT_TRUE(rve.histories.empty());
}

TEST(ReferencePair, LocalDampingCutsWorkDoneAndRaisesWorkAgainst) {
  for (const double speed : {1e-9, -1e-6}) {  // with and against the repulsion of grain 1
    Rve rve = pair_along(0, Material{});      // lambda = 0.3
    rve.velocities = {{0, 0}, {speed, 0}};
    rve.spins = {0, 0};
    step(rve, Mat2{}, Mat2{});
    const double a = mobility(rve.material, rj, rj).translation;
    const double now = kn * (overlap - speed);
    const double gain = (rve.velocities[1].x - speed) / a;
    EXPECT_NEAR(gain, speed > 0 ? 0.7 * now : 1.3 * now, 1e-10 * fn);
  }
}

TEST(ReferencePair, MomentumAndAngularMomentumOfACollision) {
  Rve rve = two_grains(ri, rj, 1e-8, 0.4, 0.05, undamped());
  rve.velocities = {{3e-7, 1e-7}, {-2e-7, -1e-7}};
  rve.spins = {5e-5, -1e-5};
  const auto [ai, ari] = mobility(rve.material, ri, rj);
  const auto [aj, arj] = mobility(rve.material, rj, rj);
  const auto momentum = [&] { return (1 / ai) * rve.velocities[0] + (1 / aj) * rve.velocities[1]; };
  const auto spin = [&] {
    return dot(left_of(rve.positions[0]), rve.velocities[0]) / ai +
           dot(left_of(rve.positions[1]), rve.velocities[1]) / aj + rve.spins[0] / ari + rve.spins[1] / arj;
  };
  const Vec2 p0 = momentum();
  const double l0 = spin();
  const double angular_scale = rve.spins[0] / ari;
  // Once apart each is a grain without force and slowed on purpose: look at the last step in contact.
  int touching = 0;
  Vec2 p1;
  double l1 = 0;
  while (step(rve, Mat2{}, Mat2{}).contact_count > 0 && touching < 100) {
    p1 = momentum();
    l1 = spin();
    ++touching;
  }
  EXPECT_GT(touching, 2);
  EXPECT_LT(touching, 100);
  EXPECT_GT(dot(rve.velocities[1] - rve.velocities[0], {std::cos(0.4), std::sin(0.4)}), 0.0);  // they have bounced
  EXPECT_GT(std::abs(rve.spins[0] - 5e-5), 1e-6);                                              // and exchanged spin
  EXPECT_NEAR(p1.x, p0.x, 1e-13 * norm(p0));
  EXPECT_NEAR(p1.y, p0.y, 1e-13 * norm(p0));
  EXPECT_NEAR(l1, l0, 1e-12 * angular_scale);
}

TEST(ReferencePair, GrainWithoutContactSlowsDown) {
  Rve rve = two_grains(ri, rj, -1e-3, 0, 0.05, Material{});
  rve.velocities = {{1e-6, 2e-6}, {0, 0}};
  rve.spins = {1e-4, 0};
  step(rve, Mat2{}, Mat2{});
  EXPECT_NEAR(rve.velocities[0].x, 0.9e-6, 1e-19);
  EXPECT_NEAR(rve.velocities[0].y, 1.8e-6, 1e-19);
  EXPECT_NEAR(rve.spins[0], 0.9e-4, 1e-17);
}

}  // namespace
}  // namespace voussoir::reference
