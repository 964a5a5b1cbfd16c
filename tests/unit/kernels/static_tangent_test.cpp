// Static tangent against closed forms, a dense solve by Eigen from the oracle's contacts, and probes of the engine
// itself.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "host/material/answers.hpp"
#include "tests/engine_support.hpp"

namespace voussoir::kernels {
namespace {

using Matrix = Eigen::Matrix3d;

EngineSettings asking(TangentKind kind, double tolerance = 1e-12) {
  EngineSettings settings = in_double();
  settings.tangent = kind;
  settings.tangent_tolerance = tolerance;
  return settings;
}

RveBatch one(reference::Rve rve) {
  rve.rotations.resize(rve.radii.size(), 0.0);
  return clones(rve, 1);
}

/// Whether `contact`'s springs are beyond `share` of their caps.
struct Yielded {
  bool sliding, rolling;
};
Yielded yielded(const reference::Rve& rve, const reference::Contact& c, double share) {
  const auto i = static_cast<std::size_t>(c.i), j = static_cast<std::size_t>(c.j);
  const double arm = rve.material.rolling_limit * std::min(rve.radii[i], rve.radii[j]);
  return {std::abs(c.tangential_force) >= share * rve.material.friction * c.normal_force,
          std::abs(c.moment) >= share * arm * c.normal_force};
}

/// D = (A - B^T K^+ B)/V of the same springs, K assembled and pseudo-inverted.
Matrix dense_tangent(const reference::Rve& rve, double share) {
  const auto n = static_cast<Eigen::Index>(3 * rve.radii.size());
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(n, n), load = Eigen::MatrixXd::Zero(n, 3);
  Matrix affine = Matrix::Zero();
  for (const reference::Contact& c : contacts(rve)) {
    const double ri = rve.radii[static_cast<std::size_t>(c.i)], rj = rve.radii[static_cast<std::size_t>(c.j)];
    const double y = (ri + rj) / c.distance, nx = c.normal.x, ny = c.normal.y;
    const Yielded gone = yielded(rve, c, share);
    const double k[3] = {c.normal_stiffness, gone.sliding ? 0.0 : c.tangential_stiffness / y,
                         gone.rolling ? 0.0 : pair_stiffness(rve.material, ri, rj).rolling};
    Matrix on_i, on_j, on_strain;
    on_i << -nx, -ny, 0, y * ny, -y * nx, -ri, 0, 0, -1;
    on_j << nx, ny, 0, -y * ny, y * nx, -rj, 0, 0, 1;
    on_strain << nx * nx, ny * ny, nx * ny, -y * nx * ny, y * nx * ny, 0.5 * y * (nx * nx - ny * ny), 0, 0, 0;
    on_strain *= c.distance;
    const Matrix springs = Eigen::Vector3d(k[0], k[1], k[2]).asDiagonal();
    const Eigen::Index a = 3 * c.i, b = 3 * c.j;
    stiffness.block<3, 3>(a, a) += on_i.transpose() * springs * on_i;
    stiffness.block<3, 3>(a, b) += on_i.transpose() * springs * on_j;
    stiffness.block<3, 3>(b, a) += on_j.transpose() * springs * on_i;
    stiffness.block<3, 3>(b, b) += on_j.transpose() * springs * on_j;
    load.middleRows<3>(a) += on_i.transpose() * springs * on_strain;
    load.middleRows<3>(b) += on_j.transpose() * springs * on_strain;
    affine += on_strain.transpose() * springs * on_strain;
  }
  for (Eigen::Index a = 0; a < n; a += 3) {  // radians against metres: the pseudo-inverse needs one unit
    const double r = rve.radii[static_cast<std::size_t>(a / 3)];
    stiffness.row(a + 2) /= r;
    stiffness.col(a + 2) /= r;
    load.row(a + 2) /= r;
  }
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  solver.setThreshold(1e-10);
  solver.compute(stiffness);
  return (affine - load.transpose() * solver.solve(load)) / (reference::det(rve.cell) * rve.material.thickness);
}

void expect_near(const Matrix& d, const Matrix& expected, double tolerance) {
  EXPECT_LT((d - expected).cwiseAbs().maxCoeff(), tolerance * expected.cwiseAbs().maxCoeff()) << d << "\n\n"
                                                                                              << expected;
}

/// Stress differences over `strain`, by unit strain in columns (from the same hold without strain), in long holds.
Matrix probe(const reference::Rve& rve, double strain) {
  EngineSettings settings = in_double();
  settings.hold_tolerance = 1e-12;
  RveBatch batch = clones(rve, 4);
  const Mat2 gradients[4] = {{}, {1, 0, 0, 0}, {0, 0, 0, 1}, {0, 0.5, 0.5, 0}};
  std::vector<StrainRequest> requests;
  for (const Mat2& g : gradients)
    requests.push_back({.f_rel = identity2 + strain * g, .strain_steps = 200, .hold_cap = 40000});
  const auto reports = run(batch, requests, settings);
  Matrix d;
  for (int a = 0; a < 3; ++a) {
    const double* s = reports[static_cast<std::size_t>(a) + 1].stress;
    const double* s0 = reports[0].stress;
    d.col(a) << s[0] - s0[0], s[3] - s0[3], 0.5 * (s[1] + s[2] - s0[1] - s0[2]);
  }
  return d / strain;
}

class StaticTangent : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    dense = reference::consolidated_packing(80, 2, 1e5, 0.0, reference::Material{});
    sheared = dense;
    strain(sheared, {1.003, 0, 0, 0.99}, {.steps = 12000, .hold_steps = 1500});
  }
  static inline reference::Rve dense, sheared;
};

TEST_F(StaticTangent, IsOffUnlessAsked) {
  RveBatch batch = clones(dense, 1);
  const RveReport r = at_rest(batch, in_double());
  EXPECT_EQ(r.tangent_kind, TangentKind::contact);
  EXPECT_EQ(r.tangent_iterations, 0);
}

// Every grain of the lattice is a centre of symmetry: nothing moves or spins but with the strain. Three bonds a grain.
TEST_F(StaticTangent, LatticeIsAffine) {
  const reference::Rve rve = reference::hexagonal_packing(6, 6, 1e-3, 1e-6, reference::Material{});
  RveBatch batch = one(rve);
  const RveReport r = at_rest(batch, asking(TangentKind::elastic));
  const auto k = reference::pair_stiffness(rve.material, 1e-3, 1e-3);
  const double y = 2e-3 / (2e-3 - 1e-6), kt = k.tangential * y;
  const double unit = 2.0 / (std::sqrt(3.0) * rve.material.thickness) * 3.0 / 8.0;
  Matrix expected;
  expected << 3 * k.normal + kt, k.normal - kt, 0, k.normal - kt, 3 * k.normal + kt, 0, 0, 0, k.normal + kt;
  expect_near(host::tangent_of(r), unit * expected, 1e-12);
  EXPECT_EQ(r.tangent_kind, TangentKind::elastic);
  EXPECT_FALSE(r.tangent_capped);
}

// A row of unlike grains: springs in series along it, and no stiffness across or in shear, since all spin together.
TEST_F(StaticTangent, RowIsSpringsInSeries) {
  reference::Rve rve;
  const double overlap = 1e-6, radii[3] = {1e-3, 1e-3, 2e-3};
  double x = 0, compliance = 0;
  for (int i = 0; i < 9; ++i) {
    const double r = radii[i % 3], next = radii[(i + 1) % 3];
    rve.positions.push_back({x, 4e-3});
    rve.radii.push_back(r);
    x += r + next - overlap;
    compliance += 1.0 / reference::pair_stiffness(rve.material, r, next).normal;
  }
  rve.cell = {x, 0, 0, 2e-2};
  RveBatch batch = one(rve);
  const RveReport contact = at_rest(batch, in_double());
  const RveReport r = at_rest(batch, asking(TangentKind::elastic));
  Matrix expected = Matrix::Zero();
  expected(0, 0) = x / (2e-2 * rve.material.thickness * compliance);
  expect_near(host::tangent_of(r), expected, 1e-12);
  EXPECT_GT(contact.tangent[0], 1.05 * expected(0, 0));
  EXPECT_GT(contact.tangent[5], 0.1 * expected(0, 0));
}

// Without resistance to rolling the block of a grain with one contact is singular itself.
TEST_F(StaticTangent, MechanismHasNone) {
  for (const double rolling : {reference::Material{}.rolling_stiffness, 0.0}) {
    reference::Material material;
    material.rolling_stiffness = rolling;
    const reference::Rve rve = reference::two_grains(1e-3, 1.5e-3, 1e-6, 0.3, 1.5e-2, material);
    for (const Precision precision : {Precision::float32, Precision::float64}) {
      EngineSettings settings = asking(TangentKind::elastic);
      settings.precision = precision;
      RveBatch batch = one(rve);
      const RveReport contact = at_rest(batch, EngineSettings{});
      const RveReport r = at_rest(batch, settings);
      EXPECT_EQ(r.tangent_kind, TangentKind::elastic);
      EXPECT_FALSE(r.tangent_capped);
      for (const double d : r.tangent) EXPECT_LT(std::abs(d), 1e-12 * contact.tangent[0]);
    }
  }
}

TEST_F(StaticTangent, FollowsTheDenseSolve) {
  for (const reference::Rve* rve : {&dense, &sheared}) {
    RveBatch batch = clones(*rve, 1);
    const Matrix told_apart = dense_tangent(*rve, 1.0 - 1e-4), stuck = dense_tangent(*rve, 2.0);
    expect_near(host::tangent_of(at_rest(batch, asking(TangentKind::static_))), told_apart, 1e-9);
    expect_near(host::tangent_of(at_rest(batch, asking(TangentKind::elastic))), stuck, 1e-9);
    const double by_default = EngineSettings{}.tangent_tolerance;
    expect_near(host::tangent_of(at_rest(batch, asking(TangentKind::static_, by_default))), told_apart, 1e-5);
    EngineSettings single = asking(TangentKind::static_, by_default);
    single.precision = Precision::float32;
    expect_near(host::tangent_of(at_rest(batch, single)), told_apart, 1e-5);
    if (rve == &dense) continue;
    EXPECT_LT(told_apart(1, 1), 0.98 * stuck(1, 1)) << "no contact slides: the test shows nothing";
  }
}

TEST_F(StaticTangent, FollowsTheDenseSolveOfGrainsThatRollFreely) {
  reference::Material material;
  material.rolling_stiffness = 0;
  const reference::Rve rve = reference::consolidated_packing(80, 4, 1e5, 0.0, material);
  RveBatch batch = one(rve);
  const Matrix expected = dense_tangent(rve, 2.0);
  expect_near(host::tangent_of(at_rest(batch, asking(TangentKind::elastic))), expected, 1e-9);
  EngineSettings single = asking(TangentKind::elastic, EngineSettings{}.tangent_tolerance);
  single.precision = Precision::float32;
  expect_near(host::tangent_of(at_rest(batch, single)), expected, 1e-5);
}

// The tolerance is that of the motions: the tangent's error is its square, and a smaller tolerance costs more.
TEST_F(StaticTangent, EndsWhereItsErrorIsTheSquareOfTheTolerance) {
  for (const reference::Rve* rve : {&dense, &sheared}) {
    RveBatch batch = clones(*rve, 1);
    const Matrix exact = dense_tangent(*rve, 2.0);
    int before = 0;
    for (const double tolerance : {0.1, 0.01, 1e-3}) {
      const RveReport r = at_rest(batch, asking(TangentKind::elastic, tolerance));
      EXPECT_FALSE(r.tangent_capped);
      EXPECT_GT(r.tangent_iterations, before) << tolerance;
      EXPECT_LE(r.tangent_iterations, 16) << tolerance;
      const Matrix d = host::tangent_of(r);
      for (int k = 0; k < 3; ++k) {
        EXPECT_GT(d(k, k), exact(k, k) * (1 - 1e-12)) << tolerance;
        EXPECT_LT(d(k, k), exact(k, k) * (1 + tolerance * tolerance)) << tolerance;
      }
      before = r.tangent_iterations;
    }
  }
}

TEST_F(StaticTangent, TellsItsTimeApart) {
  RveBatch batch = clones(dense, 40);
  const std::vector<StrainRequest> requests(40, {.hold_cap = 1});
  std::vector<RveReport> reports(40);
  const auto work_of = [&](const EngineSettings& settings) {
    return advance(batch, std::span<const StrainRequest>(requests), settings, reports);
  };
  EXPECT_EQ(work_of(in_double()).tangent_time(), 0.0);
  Work found = work_of(asking(TangentKind::elastic));
  EXPECT_GT(found.tangent_time(), 0.0);
  EXPECT_GE(found.workers, 1U);
  const double once = found.tangent_time();
  found += found;  // of two ranks at the same time
  EXPECT_DOUBLE_EQ(found.tangent_time(), once);
}

TEST_F(StaticTangent, IsPositiveAndSofterThanTheContactTangent) {
  for (const reference::Rve* rve : {&dense, &sheared}) {
    RveBatch batch = clones(*rve, 1);
    const Matrix contact = host::tangent_of(at_rest(batch, in_double()));
    for (const TangentKind kind : {TangentKind::elastic, TangentKind::static_}) {
      const Matrix d = host::tangent_of(at_rest(batch, asking(kind, 2e-3)));
      EXPECT_GT(d.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 0);
      EXPECT_GT((contact - d).selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 0);
    }
  }
}

// At isotropic pressure nothing is near its cap. After the shear the probes that unload are compared (extension along
// the compressed y, compression along x): loading slides further, and shear is either, within the sliding contacts'
// share.
TEST_F(StaticTangent, ElasticOneIsWhatSmallProbesMeasure) {
  for (const double sign : {1.0, -1.0}) {
    RveBatch batch = clones(dense, 1);
    const Matrix d = host::tangent_of(at_rest(batch, asking(TangentKind::elastic))),
                 measured = probe(dense, sign * 1e-6);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(d(k, k), measured(k, k), 0.02 * measured(k, k)) << k;
  }
  RveBatch batch = clones(sheared, 1);
  const Matrix d = host::tangent_of(at_rest(batch, asking(TangentKind::elastic)));
  EXPECT_NEAR(d(0, 0) / probe(sheared, -1e-6)(0, 0), 1.0, 0.02);
  EXPECT_NEAR(d(1, 1) / probe(sheared, 1e-6)(1, 1), 1.0, 0.02);
}

// Without friction every contact slides, and the probe has nothing else to follow.
TEST_F(StaticTangent, FrictionlessOneIsWhatSmallProbesMeasure) {
  reference::Material material;
  material.friction = 0;
  material.rolling_stiffness = 0;
  const reference::Rve rve = reference::consolidated_packing(80, 3, 1e4, 0.0, material);
  RveBatch batch = one(rve);
  const Matrix d = host::tangent_of(at_rest(batch, asking(TangentKind::static_))), measured = probe(rve, 1e-8);
  for (int k = 0; k < 2; ++k) EXPECT_NEAR(d(k, k), measured(k, k), 0.02 * measured(k, k)) << k;
}

TEST_F(StaticTangent, SameBitsAloneAndInAGroup) {
  for (const Precision precision : {Precision::float32, Precision::float64}) {
    EngineSettings settings = asking(TangentKind::static_, 2e-3);
    settings.precision = precision;
    const auto [expected, reports] = run_alone_and_in_a_group(dense, settings);
    EXPECT_TRUE(std::equal(expected.tangent, expected.tangent + 6, reports[7].tangent));
    EXPECT_EQ(expected.tangent_iterations, reports[7].tangent_iterations);
    EXPECT_EQ(reports[7].tangent_kind, TangentKind::static_);
    EXPECT_EQ(reports[3].status, RveStatus::not_finite);
    EXPECT_EQ(reports[4].status, RveStatus::open);
    for (const double d : reports[4].tangent) EXPECT_EQ(d, 0.0);
  }
}

TEST_F(StaticTangent, StopsAtItsLimitAndSaysSo) {
  EngineSettings settings = asking(TangentKind::elastic);
  settings.tangent_iterations = 3;
  RveBatch batch = clones(dense, 1);
  const RveReport capped = at_rest(batch, settings), whole = at_rest(batch, asking(TangentKind::elastic));
  EXPECT_TRUE(capped.tangent_capped);
  EXPECT_EQ(capped.tangent_iterations, 3);
  EXPECT_GT(capped.tangent[0], whole.tangent[0]);
}

}  // namespace
}  // namespace voussoir::kernels
