// The loading tangent's ways: its direction, its bits, its limits and extremes. That it is what probes measure is in
// static_step_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "host/material/answers.hpp"
#include "kernels/tangents/loading_tangent.hpp"
#include "tests/engine_support.hpp"

namespace voussoir::kernels {
namespace {

using Matrix = Eigen::Matrix3d;

EngineSettings asking(TangentKind kind, double strain = 1e-6, Precision precision = Precision::float64) {
  EngineSettings settings{.precision = precision};
  settings.tangent = kind;
  settings.tangent_strain = strain;
  return settings;
}

const StrainRequest still{.strain_steps = 400, .hold_cap = 100000};

/// Compressed along y by `strain` in the engine and held until nothing moves.
RveBatch compressed(const reference::Rve& rve, double strain, std::size_t n) {
  EngineSettings settings = in_double();
  settings.hold_tolerance = 1e-12;
  RveBatch batch = clones(rve, n);
  StrainRequest request{.f_rel = {1 + 0.3 * strain, 0, 0, 1 - strain}, .strain_steps = 12000, .hold_cap = 100000};
  run(batch, std::vector(n, request), settings);
  commit(batch);
  return batch;
}

/// Change of stress over the size of a strain, by direction in columns, from the engine. @param batch of four clones at
/// rest
Matrix probe(RveBatch& batch, double size) {
  EngineSettings settings = in_double();
  settings.hold_tolerance = 1e-12;
  const Mat2 directions[3] = {{1, 0, 0, 0}, {0, 0, 0, 1}, {0, 0.5, 0.5, 0}};
  std::vector<StrainRequest> requests(4, still);
  for (std::size_t a = 0; a < 3; ++a) requests[a + 1].f_rel = identity2 + size * directions[a];
  const auto reports = run(batch, requests, settings);
  const double* s0 = reports[0].stress;
  Matrix d;
  for (int a = 0; a < 3; ++a) {
    const double* s = reports[static_cast<std::size_t>(a) + 1].stress;
    d.col(a) << s[0] - s0[0], s[3] - s0[3], 0.5 * (s[1] + s[2] - s0[1] - s0[2]);
  }
  return d / size;
}

class LoadingTangent : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    dense = reference::consolidated_packing(80, 2, 1e5, 0.0, reference::Material{});
    sheared = compressed(dense, 0.01, 4);
  }
  static void TearDownTestSuite() { sheared = {}; }
  static inline reference::Rve dense;
  static inline RveBatch sheared;
};

// The columns are those of the signed sizes that the motion to the trial state gives.
TEST_F(LoadingTangent, GoesOnAsTheLastMotionDid) {
  RveBatch batch = sheared;
  batch.committed = RveStates("copy", batch.size(), batch.packing(0).size(), history_size<PlainEngineLaw>);
  for (std::size_t k = 0; k < batch.size(); ++k) copy_state(sheared.committed, batch.committed, k, 80);
  forget_candidates(batch);
  StrainRequest on = still;
  on.f_rel = {1 + 3e-6, 2e-6, 1e-6, 1 - 1e-5};
  const Matrix going = host::whole_tangent_of(
      run(batch, std::vector(4, on), asking(TangentKind::loading, 1e-5)).front());
  commit(batch);
  const Matrix forward = host::whole_tangent_of(at_rest(batch, asking(TangentKind::loading, 1e-5))),
               back = host::whole_tangent_of(at_rest(batch, asking(TangentKind::loading, -1e-5)));
  EXPECT_LT((going.col(0) - forward.col(0)).norm(), 6e-4 * forward.col(0).norm());
  EXPECT_LT((going.col(1) - back.col(1)).norm(), 2e-4 * back.col(1).norm());
  EXPECT_LT((going.col(2) - forward.col(2)).norm(), 8e-4 * forward.col(2).norm());
  EXPECT_GT((forward.col(0) - back.col(0)).norm(), 0.1 * back.col(0).norm())
      << "no contact slides: the test shows nothing";
  EXPECT_GT((forward.col(1) - back.col(1)).norm(), 0.05 * back.col(1).norm());
}

// Nothing reaches a cap, and no grain moves but with the strain: the elastic tangent, the turn of the forces f carried
// along the branches, -(1/V) sum f b (t.e n) sym(t n), a quarter of the stress here, and the stress's own change
// sym(sigma e) - tr e sigma.
TEST_F(LoadingTangent, OfALatticeIsTheElasticOneAndTheStressOfItsOwn) {
  reference::Rve rve = reference::hexagonal_packing(6, 6, 1e-3, 1e-6, reference::Material{});
  rve.rotations.resize(rve.radii.size(), 0.0);
  RveBatch batch = clones(rve, 1);
  const RveReport r = at_rest(batch, asking(TangentKind::loading)),
                  elastic = at_rest(batch, asking(TangentKind::elastic));
  ASSERT_EQ(r.tangent_kind, TangentKind::loading);
  const double s = r.stress[0];  // isotropic
  Matrix turn, own;
  turn << 1, -1, 0, -1, 1, 0, 0, 0, 1;
  own << 0, -1, 0, -1, 0, 0, 0, 0, 0.5;
  const Matrix expected = host::tangent_of(elastic) + 0.25 * s * turn + s * own;
  EXPECT_LT((host::whole_tangent_of(r) - expected).cwiseAbs().maxCoeff(), 1e-10 * std::abs(s))
      << host::whole_tangent_of(r) << "\n\n"
      << expected;
}

TEST_F(LoadingTangent, SameBitsAloneAndInAGroup) {
  for (const Precision precision : {Precision::float32, Precision::float64}) {
    const EngineSettings settings = asking(TangentKind::loading, 1e-5, precision);
    const auto [expected, reports] = run_alone_and_in_a_group(dense, settings);
    EXPECT_EQ(expected.tangent_kind, TangentKind::loading);
    EXPECT_TRUE(std::equal(expected.tangent, expected.tangent + 6, reports[7].tangent));
    EXPECT_TRUE(std::equal(expected.tangent_skew, expected.tangent_skew + 3, reports[7].tangent_skew));
    EXPECT_EQ(expected.tangent_iterations, reports[7].tangent_iterations);
    EXPECT_EQ(reports[3].status, RveStatus::not_finite);
    EXPECT_EQ(reports[4].status, RveStatus::open);
    for (const double d : reports[4].tangent) EXPECT_EQ(d, 0.0);
  }
}

// Within 1 % of strain the packing flows: the step has no equilibrium near by. The elastic tangent is given, and named.
TEST_F(LoadingTangent, FallsBackToTheElasticOneAndSaysSo) {
  for (const Precision precision : {Precision::float32, Precision::float64}) {
    EngineSettings few = asking(TangentKind::loading, 1e-5, precision);
    few.tangent_iterations = 20;
    few.tangent_tolerance = 1e-7;
    for (const EngineSettings& settings : {asking(TangentKind::loading, 1e-2, precision), few}) {
      EngineSettings instead = settings;
      instead.tangent = TangentKind::elastic;
      const RveReport r = at_rest(sheared, settings), elastic = at_rest(sheared, instead);
      EXPECT_EQ(r.tangent_kind, TangentKind::elastic);
      EXPECT_TRUE(r.tangent_capped);
      EXPECT_TRUE(std::equal(r.tangent, r.tangent + 6, elastic.tangent));
      for (const double skew : r.tangent_skew) EXPECT_EQ(skew, 0.0);
      EXPECT_LE(r.tangent_iterations, elastic.tangent_iterations + most_step_iterations);
    }
  }
}

// Two grains have no stiffness whatever they are asked, but for the stress that they carry.
TEST_F(LoadingTangent, MechanismHasNone) {
  reference::Rve rve = reference::two_grains(1e-3, 1.5e-3, 1e-6, 0.3, 1.5e-2, reference::Material{});
  rve.rotations.resize(2, 0.0);
  for (const Precision precision : {Precision::float32, Precision::float64}) {
    for (const double size : {1e-6, -1e-6, 1e-2}) {
      RveBatch batch = clones(rve, 1);
      const RveReport r = at_rest(batch, asking(TangentKind::loading, size, precision));
      EXPECT_EQ(r.tangent_kind, TangentKind::loading);
      EXPECT_FALSE(r.tangent_capped);
      for (const double d : r.tangent) EXPECT_LT(std::abs(d), 5 * r.pressure());
    }
  }
}

// From overlaps of 1e-6 of a diameter to 8 times those at 100 kPa, in the float of a default run too. 1e-6 is a large
// step at 1 kPa.
TEST_F(LoadingTangent, IsWhatProbesMeasureFromOneToEightHundredKilopascals) {
  for (const double pressure : {1e3, 1e4, 8e5}) {
    RveBatch batch = compressed(reference::consolidated_packing(80, 2, pressure, 0.0, reference::Material{}), 1e-3, 4);
    for (const double size : {1e-7, 1e-6}) {
      const Matrix measured = probe(batch, size);
      for (const Precision precision : {Precision::float32, Precision::float64}) {
        const RveReport r = at_rest(batch, asking(TangentKind::loading, size, precision));
        const Matrix d = host::whole_tangent_of(r);
        EXPECT_EQ(r.tangent_kind, TangentKind::loading);
        for (int a = 0; a < 3; ++a)
          EXPECT_NEAR(d(a, a) / measured(a, a), 1.0, 0.02) << pressure << ", " << size << ": " << a;
        EXPECT_NEAR(d(0, 1) / measured(0, 1), 1.0, 0.02) << pressure << ", " << size;
        EXPECT_NEAR(d(1, 0) / measured(1, 0), 1.0, 0.02) << pressure << ", " << size;
      }
    }
  }
}

}  // namespace
}  // namespace voussoir::kernels
