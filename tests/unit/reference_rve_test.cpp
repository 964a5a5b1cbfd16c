// The oracle against hand values: what the engine is measured with must be right by itself.
#include "tests/reference/reference_rve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "tests/reference/reference_packing.hpp"

namespace voussoir::reference {
namespace {

using std::numbers::pi;

// Hand values of the pair used below: r = 2 and 3 mm, E = 3 GPa.
constexpr double ri = 2e-3, rj = 3e-3, overlap = 1e-6;
constexpr double kn = 7.2e6;  // 2 E ri rj/(ri + rj)
constexpr double kt = 3.6e6;  // kn/2
constexpr double kr = 21.6;   // beta kt ri rj
constexpr double fn = 7.2;    // kn overlap
constexpr double distance = ri + rj - overlap;

Material undamped()
{
  Material material;
  material.damping = 0;
  return material;
}

Rve pair_along(double angle, const Material& material) { return two_grains(ri, rj, overlap, angle, 0.05, material); }

TEST(ReferencePair, NormalForceAndStress)
{
  const double angle = 0.3;
  Rve rve = pair_along(angle, Material{});
  const auto found = contacts(rve);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].normal.x, std::cos(angle), 1e-12);
  EXPECT_NEAR(found[0].normal.y, std::sin(angle), 1e-12);
  EXPECT_NEAR(found[0].overlap, overlap, 1e-16);
  EXPECT_NEAR(found[0].normal_force, fn, 1e-9 * fn);  // overlap/r = 4e-4 costs 4 digits of 16
  const double c = std::cos(angle), s = std::sin(angle);
  const double scale = -fn * distance / (0.05 * 0.05 * 0.1);
  const Voigt sigma = stress(rve);
  EXPECT_NEAR(sigma[0], scale * c * c, 1e-9 * std::abs(scale));
  EXPECT_NEAR(sigma[1], scale * s * s, 1e-9 * std::abs(scale));
  EXPECT_NEAR(sigma[2], scale * c * s, 1e-9 * std::abs(scale));
  EXPECT_EQ(coordination_number(rve), 1.0);
}

TEST(ReferencePair, StressOfTangentialForceIsSymmetrised)
{
  Rve rve = pair_along(0, Material{});
  rve.histories[{0, 1}] = {.tangential = 2.0, .moment = 0};
  const double scale = distance / (0.05 * 0.05 * 0.1);
  const Mat2 raw = love_weber(rve, contacts(rve));  // P = (-fn, ft), b = (distance, 0)
  EXPECT_NEAR(raw.yx, 2.0 * scale, 1e-9 * scale);
  EXPECT_EQ(raw.xy, 0.0);
  EXPECT_NEAR(stress(rve)[2], scale, 1e-9 * scale);
}

TEST(ReferencePair, TangentByHand)
{
  const VoigtMatrix d = tangent(pair_along(0, Material{}));  // n = (1, 0), t = (0, 1)
  const double scale = distance * distance / (0.05 * 0.05 * 0.1);
  EXPECT_NEAR(d[0][0], kn * scale, 1e-9 * kn * scale);
  EXPECT_NEAR(d[2][2], 0.25 * kt * scale, 1e-9 * kt * scale);  // (t n + n t)/2 twice
  EXPECT_EQ(d[0][1], 0.0);
  EXPECT_EQ(d[1][1], 0.0);
  EXPECT_EQ(d[0][2], 0.0);
}

TEST(ReferencePair, ContactThroughThePeriodicBoundary)
{
  Rve rve = pair_along(0.7, Material{});
  rve.cell = {0.05, 0.03, 0, 0.05};
  const Voigt before = stress(rve);
  rve.positions[1] = rve.positions[1] + Vec2{2 * 0.05 - 0.03, -0.05};
  const Voigt after = stress(rve);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(after[k], before[k], 1e-9 * std::abs(before[0]));
}

// In the next tests the motion is far smaller than the overlap, so that f_n and n change by less than the tolerance.
TEST(ReferencePair, TranslationShears)
{
  Rve rve = pair_along(0, undamped());
  const double slide = 1e-9;
  rve.velocities = {{0, 0}, {0, slide}};
  rve.spins = {0, 0};
  step(rve, Mat2{}, Mat2{});
  const double y = (ri + rj) / distance;
  EXPECT_NEAR(rve.histories.at({0, 1}).tangential, kt * y * slide, 1e-8 * kt * slide);
  EXPECT_EQ(rve.histories.at({0, 1}).moment, 0.0);
}

TEST(ReferencePair, AffineMotionShearsAndRotationDoesNot)
{
  Rve rve = pair_along(0, undamped());
  const double gamma = 2e-7;
  step(rve, Mat2{0, gamma, 0, 0}, Mat2{});  // D_yx = gamma/2, sliding y D b.t = (ri + rj) gamma/2
  EXPECT_NEAR(rve.histories.at({0, 1}).tangential, kt * (ri + rj) * 0.5 * gamma, 1e-6 * kt * (ri + rj) * gamma);
  Rve turned = pair_along(0.4, undamped());
  step(turned, Mat2{0, -1e-3, 1e-3, 0}, Mat2{});
  EXPECT_NEAR(turned.histories.at({0, 1}).tangential, 0.0, 1e-12 * fn);
  EXPECT_NEAR(contacts(turned)[0].normal_force, fn, 1e-9 * fn);
}

TEST(ReferencePair, EqualSpinsShearAndOppositeSpinsRoll)
{
  const double spin = 1e-8;
  Rve sheared = pair_along(0.2, undamped());
  sheared.velocities = {{0, 0}, {0, 0}};
  sheared.spins = {spin, spin};
  step(sheared, Mat2{}, Mat2{});
  EXPECT_NEAR(sheared.histories.at({0, 1}).tangential, -kt * (ri + rj) * spin, 1e-9 * kt * (ri + rj) * spin);
  EXPECT_EQ(sheared.histories.at({0, 1}).moment, 0.0);

  Rve rolled = pair_along(0.2, undamped());
  rolled.velocities = {{0, 0}, {0, 0}};
  rolled.spins = {-spin / ri, spin / rj};  // r_i theta_i + r_j theta_j = 0: rolling without sliding
  step(rolled, Mat2{}, Mat2{});
  EXPECT_NEAR(rolled.histories.at({0, 1}).tangential, 0.0, 1e-12);
  const double moment = kr * spin * (1 / ri + 1 / rj);
  EXPECT_NEAR(rolled.histories.at({0, 1}).moment, moment, 1e-9 * moment);
}

TEST(ReferencePair, ForcesAndTorquesOnBothGrains)
{
  Rve rve = pair_along(0, undamped());
  const double ft = 1.5, m = 2e-3;
  rve.histories[{0, 1}] = {.tangential = ft, .moment = m};
  step(rve, Mat2{}, Mat2{});
  const auto [ai, ari] = mobility(rve.material, ri);
  const auto [aj, arj] = mobility(rve.material, rj);
  EXPECT_NEAR(rve.velocities[0].x, -ai * fn, 1e-8 * ai * fn);
  EXPECT_NEAR(rve.velocities[0].y, ai * ft, 1e-8 * ai * fn);
  EXPECT_NEAR(rve.velocities[1].x, aj * fn, 1e-8 * aj * fn);
  EXPECT_NEAR(rve.velocities[1].y, -aj * ft, 1e-8 * aj * fn);
  EXPECT_NEAR(rve.spins[0], ari * ((ri - 0.5 * overlap) * ft + m), 1e-8 * ari * m);
  EXPECT_NEAR(rve.spins[1], arj * ((rj - 0.5 * overlap) * ft - m), 1e-8 * arj * m);
}

TEST(ReferencePair, MobilitiesByHand)
{
  const auto [a, ar] = mobility(Material{}, 2e-3);  // k_n = 6e6, k_t = 3e6, beta = 1, c = 0.9
  EXPECT_NEAR(a, 0.81 * 4 / (36e6 + 36e6), 1e-20);
  EXPECT_NEAR(ar, 0.81 * 4 / ((72e6 + 36e6) * 4e-6), 1e-14);
}

TEST(ReferencePair, CoulombAndRollingCaps)
{
  Rve rve = pair_along(0, undamped());
  rve.velocities = {{0, 0}, {0, -1e-6}};  // half the overlap: k_t s = 3.6 N, the cap is 0.466 f_n = 3.36 N
  rve.spins = {-1e-3 / ri, 1e-3 / rj};
  step(rve, Mat2{}, Mat2{});
  const double now = kn * (ri + rj - std::hypot(distance, 1e-6));
  EXPECT_NEAR(rve.histories.at({0, 1}).tangential, -0.466307658 * now, 1e-8 * fn);
  EXPECT_NEAR(rve.histories.at({0, 1}).moment, 0.6 * ri * now, 1e-8 * ri * fn);
}

TEST(ReferencePair, CapsFollowTheNormalForceAndSeparationForgets)
{
  Rve rve = pair_along(0, undamped());
  rve.histories[{0, 1}] = {.tangential = 3.0, .moment = -5e-3};
  rve.velocities = {{0, 0}, {0.5e-6, 0}};  // f_n halves; both histories now exceed their caps
  rve.spins = {0, 0};
  step(rve, Mat2{}, Mat2{});
  EXPECT_NEAR(rve.histories.at({0, 1}).tangential, 0.466307658 * 0.5 * fn, 1e-8 * fn);
  EXPECT_NEAR(rve.histories.at({0, 1}).moment, -0.6 * ri * 0.5 * fn, 1e-8 * ri * fn);
  rve.velocities = {{0, 0}, {0.6e-6, 0}};
  step(rve, Mat2{}, Mat2{});
  EXPECT_TRUE(rve.histories.empty());
}

TEST(ReferencePair, LocalDampingCutsWorkDoneAndRaisesWorkAgainst)
{
  for (const double speed : {1e-9, -1e-6}) {  // with and against the repulsion of grain 1
    Rve rve = pair_along(0, Material{});      // lambda = 0.3
    rve.velocities = {{0, 0}, {speed, 0}};
    rve.spins = {0, 0};
    step(rve, Mat2{}, Mat2{});
    const double a = mobility(rve.material, rj).translation;
    const double now = kn * (overlap - speed);
    const double gain = (rve.velocities[1].x - speed) / a;
    EXPECT_NEAR(gain, speed > 0 ? 0.7 * now : 1.3 * now, 1e-7 * fn);
  }
}

TEST(ReferencePair, MomentumAndAngularMomentumOfACollision)
{
  Rve rve = two_grains(ri, rj, 1e-8, 0.4, 0.05, undamped());
  rve.velocities = {{3e-7, 1e-7}, {-2e-7, -1e-7}};
  rve.spins = {5e-5, -1e-5};
  const auto [ai, ari] = mobility(rve.material, ri);
  const auto [aj, arj] = mobility(rve.material, rj);
  const auto momentum = [&] { return (1 / ai) * rve.velocities[0] + (1 / aj) * rve.velocities[1]; };
  const auto spin = [&] {
    return dot(left_of(rve.positions[0]), rve.velocities[0]) / ai + dot(left_of(rve.positions[1]), rve.velocities[1]) / aj +
           rve.spins[0] / ari + rve.spins[1] / arj;
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
  EXPECT_GT(std::abs(rve.spins[0] - 5e-5), 1e-6);                                             // and exchanged spin
  EXPECT_NEAR(p1.x, p0.x, 1e-12 * norm(p0));
  EXPECT_NEAR(p1.y, p0.y, 1e-12 * norm(p0));
  EXPECT_NEAR(l1, l0, 1e-11 * angular_scale);
}

TEST(ReferencePair, GrainWithoutContactSlowsDown)
{
  Rve rve = two_grains(ri, rj, -1e-3, 0, 0.05, Material{});
  rve.velocities = {{1e-6, 2e-6}, {0, 0}};
  rve.spins = {1e-4, 0};
  step(rve, Mat2{}, Mat2{});
  EXPECT_NEAR(rve.velocities[0].x, 0.9e-6, 1e-18);
  EXPECT_NEAR(rve.velocities[0].y, 1.8e-6, 1e-18);
  EXPECT_NEAR(rve.spins[0], 0.9e-4, 1e-16);
}

TEST(ReferenceRve, RejectsACellThatIsTooSmall)
{
  Rve rve = two_grains(ri, rj, overlap, 0, 0.05, Material{});
  rve.cell = {0.011, 0, 0, 0.05};
  EXPECT_THROW(stress(rve), std::invalid_argument);
  rve.cell = {0.05, 0, 0, -0.05};
  EXPECT_THROW(stress(rve), std::invalid_argument);
  rve.cell = {0.05, 0, 0, 0.05};
  rve.radii.pop_back();
  EXPECT_THROW(stress(rve), std::invalid_argument);
}

TEST(ReferencePlane, ExponentialAndLogarithmCompoundToTheWhole)
{
  const double c = std::cos(2.5), s = std::sin(2.5);
  for (const Mat2& f : {Mat2{1.1, 0.4, -0.1, 0.8}, Mat2{c, -s, s, c}, Mat2{1, 1e-9, 0, 1}, Mat2{2, 3, 0.1, 0.7}}) {
    const Mat2 e = exponential_minus_identity((1.0 / 37) * logarithm(f));
    Mat2 product = identity;
    for (int k = 0; k < 37; ++k) product = product + e * product;
    const Mat2 error = product - f;
    EXPECT_LT(std::abs(error.xx) + std::abs(error.xy) + std::abs(error.yx) + std::abs(error.yy), 1e-13);
  }
  EXPECT_THROW(logarithm({-1, 0, 0, -1}), std::invalid_argument);
  EXPECT_THROW(logarithm({1, 0, 0, -1}), std::invalid_argument);
}

/// Triangular lattice, spacing d, area per grain (sqrt(3)/2) d^2, three contacts per grain at 0, 60, 120 degrees. With
/// sum n_x^4 = 9/8, sum n_x^2 n_y^2 = 3/8, sum n_x^3 n_y = 0, eq. (4) gives the isotropic plane moduli
///   D11 = (sqrt(3)/4t)(3 kn + kt), D12 = (sqrt(3)/4t)(kn - kt), D33 = (sqrt(3)/4t)(kn + kt),
/// so K = (D11 + D12)/2 = sqrt(3) kn/(2t) and G = D33. Exact for sticking contacts: every grain is a centre of symmetry, so
/// that under a homogeneous strain no grain feels a net force, and the sum of f_t over its six contacts, hence its torque, is
/// zero as well: neither non-affine motion nor spin appears.
struct Hexagonal {
  Material material;
  double radius = 2e-3;
  double overlap = 2e-8;  // overlap/d = 5e-6, the size of the geometric terms that eq. (4) leaves out
  double kn = material.modulus * radius;
  double factor = std::sqrt(3.0) / (4 * material.thickness);
  double ratio = material.stiffness_ratio;
  Rve rve = hexagonal_packing(6, 8, radius, overlap, material);
};

TEST(ReferenceHexagonal, TangentIsTheClosedForm)
{
  const Hexagonal hex;
  const VoigtMatrix d = tangent(hex.rve);
  const double scale = hex.factor * hex.kn;
  EXPECT_NEAR(d[0][0], scale * (3 + hex.ratio), 1e-9 * scale);
  EXPECT_NEAR(d[1][1], scale * (3 + hex.ratio), 1e-9 * scale);
  EXPECT_NEAR(d[0][1], scale * (1 - hex.ratio), 1e-9 * scale);
  EXPECT_NEAR(d[2][2], scale * (1 + hex.ratio), 1e-9 * scale);
  EXPECT_NEAR(d[0][2], 0, 1e-9 * scale);
  EXPECT_NEAR(d[1][2], 0, 1e-9 * scale);
  EXPECT_EQ(coordination_number(hex.rve), 6.0);
}

TEST(ReferenceHexagonal, StressOfIsotropicCompression)
{
  Hexagonal hex;
  const double ratio = 0.998;
  const StrainReport report = strain(hex.rve, ratio * identity, {.steps = 50});
  const double d = ratio * (2 * hex.radius - hex.overlap);
  const double sigma = -std::sqrt(3.0) * hex.kn * (2 * hex.radius - d) / (d * hex.material.thickness);  // exact at any overlap
  const Voigt s = stress(hex.rve);
  EXPECT_NEAR(s[0], sigma, 1e-9 * std::abs(sigma));
  EXPECT_NEAR(s[1], sigma, 1e-9 * std::abs(sigma));
  EXPECT_NEAR(s[2], 0, 1e-9 * std::abs(sigma));
  EXPECT_EQ(report.steps, 50);
}

TEST(ReferenceHexagonal, StrainedResponseIsTheTangent)
{
  const double e = 1e-6;  // a fifth of the overlap strain: nothing opens, nothing slides
  const double unit = Hexagonal{}.factor * Hexagonal{}.kn * e;
  struct Path {
    Mat2 strain;
    Voigt stress;
  };
  const double r = Hexagonal{}.ratio;
  for (const auto& [h, expected] : {Path{{e, 0, 0, e}, {4.0, 4.0, 0}},                 // 2K = 4 unit
                                    Path{{e, 0, 0, -e}, {2 * (1 + r), -2 * (1 + r), 0}},  // 2G
                                    Path{{0, 0.5 * e, 0.5 * e, 0}, {0, 0, 1 + r}},
                                    Path{{0, e, 0, 0}, {0, 0, 1 + r}},                    // with rotation: the same
                                    Path{{0, -e, e, 0}, {0, 0, 0}}}) {
    Hexagonal hex;
    hex.rve.material.friction = 10;
    const Voigt before = stress(hex.rve);
    strain(hex.rve, identity + h, {.steps = 20});
    const Voigt after = stress(hex.rve);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(after[k] - before[k], unit * expected[k], 5e-5 * unit);
    for (const double angle : hex.rve.rotations) EXPECT_NEAR(angle, 0.5 * (h.yx - h.xy), 1e-5 * e);
  }
}

TEST(ReferenceHexagonal, LocalDampingLosesAFixedShareOfEveryHalfCycle)
{
  // All grains spin alike: one oscillator, sliding -2 r theta in each contact, no net force. Towards rest its torque is cut by
  // 1 - lambda, away from it raised by 1 + lambda: successive peaks of f_t^2 have the ratio (1 - lambda)/(1 + lambda).
  Hexagonal hex;
  hex.rve = hexagonal_packing(6, 6, hex.radius, 2e-6, hex.material);
  hex.rve.material.friction = 10;
  hex.rve.material.step_safety = 0.004;  // some 600 steps in a half cycle, so that the continuous formula holds
  hex.rve.velocities.assign(36, {});
  hex.rve.spins.assign(36, 1e-7);
  std::vector<double> peaks;
  double before = 0, last = 0;
  for (int k = 0; k < 3000; ++k) {
    step(hex.rve, Mat2{}, Mat2{});
    const double now = std::abs(hex.rve.histories.begin()->second.tangential);
    if (last > before && last >= now) peaks.push_back(last * last);
    before = last;
    last = now;
  }
  ASSERT_GE(peaks.size(), 4u);
  for (std::size_t k = 1; k < 4; ++k) EXPECT_NEAR(peaks[k] / peaks[k - 1], 0.7 / 1.3, 0.01);
}

class ReferencePacking : public testing::Test {
 protected:
  static void SetUpTestSuite() { packing_ = new Rve(consolidated_packing(40, 2, 1e5, 0.0, Material{})); }
  static void TearDownTestSuite() { delete packing_; }
  static inline Rve* packing_ = nullptr;
};

TEST_F(ReferencePacking, IsDenseAndAtRest)
{
  const Voigt s = stress(*packing_);
  EXPECT_NEAR(pressure(s), 1e5, 2e3);
  EXPECT_GT(coordination_number(*packing_), 3.0);
  Rve copy = *packing_;
  const StrainReport report = strain(copy, identity, {.steps = 1, .hold_steps = 5000, .tolerance = 1e-6});
  EXPECT_TRUE(report.met_tolerance);
  EXPECT_LT(report.steps, 5001);
  EXPECT_EQ((report.steps - 1) % 16, 0);
}

TEST_F(ReferencePacking, RigidRotationRotatesStressAndNothingElse)
{
  const StrainOptions options{.steps = 500, .hold_steps = 200};
  Rve turned = *packing_;
  strain(turned, Mat2{0, -1, 1, 0}, options);
  Rve still = *packing_;
  strain(still, identity, options);
  // F = a quarter turn: (xx, yy, xy) -> (yy, xx, -xy).
  const Voigt a = stress(still), b = stress(turned);
  const double p = pressure(a);
  EXPECT_NEAR(b[0], a[1], 1e-6 * p);
  EXPECT_NEAR(b[1], a[0], 1e-6 * p);
  EXPECT_NEAR(b[2], -a[2], 1e-6 * p);
  EXPECT_NEAR(mean_rotation(turned), mean_rotation(still) + 0.5 * pi, 1e-9);
  const auto ca = contacts(still), cb = contacts(turned);
  ASSERT_EQ(ca.size(), cb.size());
  for (std::size_t k = 0; k < ca.size(); ++k) {
    EXPECT_NEAR(ca[k].tangential_force, cb[k].tangential_force, 1e-3);  // of forces of some 40 N
    EXPECT_NEAR(ca[k].normal.x, cb[k].normal.y, 1e-6);
  }
}

TEST_F(ReferencePacking, StrainEndsExactlyAtF)
{
  Rve rve = *packing_;
  const Mat2 f{1.002, 0.003, -0.001, 0.997};
  const Mat2 expected = f * rve.cell;
  const StrainReport report = strain(rve, f, {.steps = 200, .hold_steps = 64, .tolerance = 0, .keep_trace = true});
  EXPECT_EQ(report.trace.size(), 264u);
  EXPECT_FALSE(report.met_tolerance);
  EXPECT_NEAR(rve.cell.xx, expected.xx, 1e-12);
  EXPECT_NEAR(rve.cell.xy, expected.xy, 1e-12);
  EXPECT_NEAR(rve.cell.yx, expected.yx, 1e-12);
  EXPECT_NEAR(rve.cell.yy, expected.yy, 1e-12);
  for (const Vec2 w : rve.velocities) EXPECT_EQ(norm(w), 0.0);
}

TEST_F(ReferencePacking, MomentumIsConservedWithoutDamping)
{
  Rve rve = *packing_;
  rve.material.damping = 0;
  rve.velocities.assign(rve.positions.size(), {});
  rve.spins.assign(rve.positions.size(), 0);
  rve.velocities[0] = {3e-6, -1e-6};
  const auto momentum = [&rve] {
    Vec2 sum;
    for (std::size_t i = 0; i < rve.radii.size(); ++i) {
      sum = sum + (1 / mobility(rve.material, rve.radii[i]).translation) * rve.velocities[i];
    }
    return sum;
  };
  const Vec2 before = momentum();
  // Without damping a rattler's 0.9 is the only sink: it must not act while the pulse runs, hence few steps.
  for (int k = 0; k < 20; ++k) step(rve, Mat2{}, Mat2{});
  EXPECT_NEAR(momentum().x, before.x, 1e-9 * norm(before));
  EXPECT_NEAR(momentum().y, before.y, 1e-9 * norm(before));
}

TEST_F(ReferencePacking, EnergyDecaysAfterAKick)
{
  Rve rve = *packing_;
  const double rest = energy(rve);
  rve.velocities.assign(rve.positions.size(), {});
  rve.spins.assign(rve.positions.size(), 1e-3);
  for (std::size_t i = 0; i < rve.velocities.size(); i += 2) rve.velocities[i] = {4e-6, -2e-6};
  double last = energy(rve);
  ASSERT_GT(last, 1.05 * rest);
  for (int block = 0; block < 10; ++block) {
    for (int k = 0; k < 50; ++k) step(rve, Mat2{}, Mat2{});
    const double now = energy(rve);
    EXPECT_LT(now, last * (1 + 1e-9));
    last = now;
  }
  EXPECT_NEAR(last, rest, 0.2 * rest);  // some contacts have slid: not the same state
}

TEST_F(ReferencePacking, FrictionSwitchHoldsTheNewCap)
{
  Rve rve = *packing_;
  strain(rve, {1, 0.01, 0, 1}, {.steps = 1000, .hold_steps = 200});
  switch_friction(rve, 0.1);
  for (const Contact& c : contacts(rve)) {
    EXPECT_LE(std::abs(c.tangential_force), 0.1 * c.normal_force * (1 + 1e-12));
    EXPECT_LE(std::abs(c.moment), 0.6 * std::min(rve.radii[c.i], rve.radii[c.j]) * c.normal_force * (1 + 1e-12));
  }
}

}  // namespace
}  // namespace voussoir::reference
