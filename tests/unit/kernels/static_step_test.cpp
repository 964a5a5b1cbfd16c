// What a probe of finite size measures: the elastic tangent until contacts reach their caps, then the law's own step
// with them.
//
// A state at rest has no contact at its cap: while the packing settles, f_n swings and every sliding contact is left a
// little within (here 1e-5 to 1e-3 of the cap). So its tangent is the elastic one, and a larger probe measures a
// secant.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "host/material/answers.hpp"
#include "kernels/state/committed_contacts.hpp"
#include "tests/engine_support.hpp"

namespace voussoir::kernels {
namespace {

using Voigt = Eigen::Vector3d;  ///< xx, yy, xy; of strains gamma_xy

/// A contact as what the law makes of a small motion: strains (normal, sliding, rolling) to changes of (f_n pulled, f_t
/// / y, m).
struct Spring {
  CommittedContact at;
  PairConstants k;
  double length, ratio, radius_i, radius_j;
  int slides = 0, rolls = 0;  ///< sign of the force that follows its cap; 0: stuck

  [[nodiscard]] Eigen::Matrix<double, 3, 6> strains() const {  // by (u_i, u_j), docs/explanation/contact_law.md
    const double nx = at.normal_x, ny = at.normal_y, y = ratio;
    Eigen::Matrix<double, 3, 6> b;
    b << -nx, -ny, 0, nx, ny, 0, y * ny, -y * nx, -radius_i, -y * ny, y * nx, -radius_j, 0, 0, -1, 0, 0, 1;
    return b;
  }
  [[nodiscard]] Eigen::Vector2d displacement(const Voigt& e) const {  // of the branch under a uniform strain
    return {e[0] * at.branch_x + 0.5 * e[2] * at.branch_y, 0.5 * e[2] * at.branch_x + e[1] * at.branch_y};
  }
  /// f_t = +- mu f_n and m = +- arm f_n of a contact at its cap: nonsymmetric.
  [[nodiscard]] Eigen::Matrix3d stiffness() const {
    Eigen::Matrix3d s = Eigen::Vector3d(k.normal_stiffness, k.tangential_stiffness / ratio, k.rolling_stiffness)
                            .asDiagonal();
    if (slides != 0) s.row(1) << -slides * k.friction * k.normal_stiffness / ratio, 0, 0;
    if (rolls != 0) s.row(2) << -rolls * k.rolling_arm * k.normal_stiffness, 0, 0;
    return s;
  }
  /// What separates it from its caps now, and is used up first.
  [[nodiscard]] Eigen::Vector3d margins() const {
    return {0, slides == 0 ? 0.0 : (slides * k.friction * at.normal_force - at.tangential_force) / ratio,
            rolls == 0 ? 0.0 : rolls * k.rolling_arm * at.normal_force - at.moment};
  }
};

std::vector<Spring> springs_of(const RveBatch& batch) {
  std::vector<CommittedContact> contacts;
  committed_contacts(batch, 0, contacts);
  const Packing& packing = batch.packing(0);
  std::vector<Spring> out;
  for (const CommittedContact& c : contacts) {
    const auto i = static_cast<std::size_t>(c.i), j = static_cast<std::size_t>(c.j);
    const double ri = packing.radii[i], rj = packing.radii[j], length = std::hypot(c.branch_x, c.branch_y);
    out.push_back(
        {c, combine(packing.material_of(i), ri, packing.material_of(j), rj), length, (ri + rj) / length, ri, rj});
  }
  return out;
}

/// Equilibrium of a small step, all else linear. Forces that are carried already turn with their contacts.
class Step {
 public:
  Step(const RveBatch& batch, const Voigt& strain) : springs_(springs_of(batch)), strain_(strain) {
    n_ = static_cast<Eigen::Index>(batch.packing(0).size());
    const RveStates& s = batch.committed;
    volume_ = (s.cell(0, 0) * s.cell(0, 3) - s.cell(0, 1) * s.cell(0, 2)) * batch.packing(0).thickness;
    for (int round = 0; round < 50; ++round) {
      solve();
      if (!change_caps()) return;
    }
    ADD_FAILURE() << "the contacts at their caps are not found";
  }

  [[nodiscard]] int at_caps() const {
    return static_cast<int>(
        std::count_if(springs_.begin(), springs_.end(), [](const Spring& s) { return s.slides != 0 || s.rolls != 0; }));
  }

  /// Change of sigma = (1/V) sum P (x) b: of the forces, of the branches, of the volume.
  [[nodiscard]] Voigt stress_change() const {
    Eigen::Matrix2d change = Eigen::Matrix2d::Zero(), carried = Eigen::Matrix2d::Zero();
    for (const Spring& s : springs_) {
      const Eigen::Vector2d n(s.at.normal_x, s.at.normal_y), t(-n[1], n[0]), b(s.at.branch_x, s.at.branch_y);
      const Eigen::Vector3d e = strains(s), f = s.stiffness() * e + s.margins();
      const Eigen::Vector2d db = s.displacement(strain_) + far_end(s) - near_end(s);
      const double turn = t.dot(db) / s.length;
      const Eigen::Vector2d force(s.at.force_x(), s.at.force_y());
      const Eigen::Vector2d df = f[0] * n + s.ratio * f[1] * t + turn * Eigen::Vector2d(-force[1], force[0]);
      change += df * b.transpose() + force * db.transpose();
      carried += force * b.transpose();
    }
    const Eigen::Matrix2d d = (change - (strain_[0] + strain_[1]) * carried) / volume_;
    return {d(0, 0), d(1, 1), 0.5 * (d(0, 1) + d(1, 0))};
  }

 private:
  std::vector<Spring> springs_;
  Voigt strain_;
  Eigen::Index n_;
  double volume_;
  Eigen::VectorXd motion_;

  [[nodiscard]] Eigen::Vector2d near_end(const Spring& s) const { return motion_.segment<2>(3 * s.at.i); }
  [[nodiscard]] Eigen::Vector2d far_end(const Spring& s) const { return motion_.segment<2>(3 * s.at.j); }
  [[nodiscard]] Eigen::Vector3d strains(const Spring& s) const {
    Eigen::Matrix<double, 6, 1> u;
    u << motion_.segment<3>(3 * s.at.i), motion_.segment<3>(3 * s.at.j);
    return s.strains() * u + affine(s);
  }
  [[nodiscard]] Eigen::Vector3d affine(const Spring& s) const {
    const Eigen::Vector2d d = s.displacement(strain_);
    const double along = d[1] * s.at.normal_x - d[0] * s.at.normal_y;
    return {d[0] * s.at.normal_x + d[1] * s.at.normal_y, s.ratio * along, 0};
  }

  void solve() {
    Eigen::MatrixXd k = Eigen::MatrixXd::Zero(3 * n_, 3 * n_);
    Eigen::VectorXd load = Eigen::VectorXd::Zero(3 * n_);
    for (const Spring& s : springs_) {
      const auto b = s.strains();
      const Eigen::Vector3d e = affine(s);
      Eigen::Matrix<double, 6, 6> on = b.transpose() * s.stiffness() * b;
      Eigen::Matrix<double, 6, 1> f = b.transpose() * (s.stiffness() * e + s.margins());
      Eigen::Matrix<double, 6, 1> turned;  // the carried force, turned by a right angle, on both grains
      turned << -s.at.force_y(), s.at.force_x(), 0, s.at.force_y(), -s.at.force_x(), 0;
      Eigen::Matrix<double, 1, 6> turn = b.row(1) / (s.ratio * s.length);
      turn[2] = turn[5] = 0;
      on -= turned * turn;
      f -= turned * e[1] / (s.ratio * s.length);
      const Eigen::Index at[6] = {3 * s.at.i, 3 * s.at.i + 1, 3 * s.at.i + 2,
                                  3 * s.at.j, 3 * s.at.j + 1, 3 * s.at.j + 2};
      for (int p = 0; p < 6; ++p) {
        load[at[p]] -= f[p];
        for (int q = 0; q < 6; ++q) k(at[p], at[q]) += on(p, q);
      }
    }
    constexpr double metre = 2e-3;  // radians against metres: the pseudo-inverse needs one unit
    for (Eigen::Index a = 2; a < 3 * n_; a += 3) {
      k.row(a) /= metre;
      k.col(a) /= metre;
      load[a] /= metre;
    }
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
    solver.setThreshold(1e-11);
    motion_ = solver.compute(k).solve(load);
    for (Eigen::Index a = 2; a < 3 * n_; a += 3) motion_[a] /= metre;
  }

  /// Contacts whose springs alone would pass a cap follow it, and only those. True while that changes.
  bool change_caps() {
    bool changed = false;
    for (Spring& s : springs_) {
      const Eigen::Vector3d e = strains(s);
      const double fn = s.at.normal_force - s.k.normal_stiffness * e[0];
      const auto beyond = [](double x, double cap) { return std::abs(x) > cap * (1 + 1e-12) ? (x > 0 ? 1 : -1) : 0; };
      const int slides = beyond(s.at.tangential_force + s.k.tangential_stiffness * e[1], s.k.friction * fn);
      const int rolls = beyond(s.at.moment + s.k.rolling_stiffness * e[2], s.k.rolling_arm * fn);
      changed = changed || slides != s.slides || rolls != s.rolls;
      s.slides = slides;
      s.rolls = rolls;
    }
    return changed;
  }
};

EngineSettings to_the_end(TangentKind kind = TangentKind::contact) {
  EngineSettings settings = in_double();
  settings.hold_tolerance = 1e-13;
  settings.tangent = kind;
  settings.tangent_tolerance = 1e-12;
  return settings;
}

class StaticStep : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const reference::Rve isotropic = reference::consolidated_packing(80, 2, 1e5, 0.0, reference::Material{});
    reference::Rve sheared = isotropic;
    strain(sheared, {1.003, 0, 0, 0.99}, {.steps = 12000, .hold_steps = 1500});
    add(isotropic, {});
    add(sheared, {});
    add(isotropic, {.f_rel = {1.015, 0, 0, 0.95}, .strain_steps = 60000});
  }
  static void add(const reference::Rve& rve, StrainRequest to) {
    to.hold_cap = 200000;
    states.push_back(clones(rve, 2));
    run(states.back(), std::vector<StrainRequest>(2, to), to_the_end());
    commit(states.back());
  }
  static void TearDownTestSuite() { states.clear(); }

  /// Change of stress under `strain`, in the engine; the batch is not committed.
  static Voigt probe(int state, const Voigt& strain) {
    RveBatch& batch = states[static_cast<std::size_t>(state)];
    const Mat2 f{1 + strain[0], 0.5 * strain[2], 0.5 * strain[2], 1 + strain[1]};
    const auto r = run(
        batch, {{.strain_steps = 400, .hold_cap = 100000}, {.f_rel = f, .strain_steps = 400, .hold_cap = 100000}},
        to_the_end());
    const double *a = r[0].stress, *b = r[1].stress;
    return {b[0] - a[0], b[3] - a[3], 0.5 * (b[1] + b[2] - a[1] - a[2])};
  }

  /// The loading tangent at rest, columns by unit strain. @param size of the strain it is the secant of; its sign: of
  /// all directions
  static Eigen::Matrix3d loading(int state, double size, const EngineSettings& like) {
    EngineSettings settings = like;
    settings.tangent = TangentKind::loading;
    settings.tangent_strain = size;
    const RveReport r = run(states[static_cast<std::size_t>(state)], std::vector<StrainRequest>(2), settings).front();
    EXPECT_EQ(r.tangent_kind, TangentKind::loading);
    EXPECT_FALSE(r.tangent_capped);
    return host::whole_tangent_of(r);
  }

  /// Elastic tangent times `strain`, and what the stress itself changes by: sigma e + e sigma (half of it: the
  /// branches), - tr e sigma.
  static Voigt elastic(int state, const Voigt& strain) {
    RveBatch& batch = states[static_cast<std::size_t>(state)];
    const RveReport r = run(batch, std::vector<StrainRequest>(2), to_the_end(TangentKind::elastic)).front();
    const double xx = r.stress[0], yy = r.stress[3], xy = 0.5 * (r.stress[1] + r.stress[2]), tr = strain[0] + strain[1];
    const Voigt carried(xx * strain[0] + xy * 0.5 * strain[2], yy * strain[1] + xy * 0.5 * strain[2],
                        0.5 * (0.5 * strain[2] * (xx + yy) + xy * tr));
    return host::tangent_of(r) * strain + carried - tr * Voigt(xx, yy, xy);
  }

  static inline std::vector<RveBatch> states;  ///< isotropic, sheared to 1 % and to 5 %
};

const Voigt directions[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

TEST_F(StaticStep, SmallProbesMeasureTheElasticTangent) {
  for (const int state : {0, 1}) {
    for (const Voigt& e : directions) {
      const Voigt measured = probe(state, 1e-7 * e), expected = elastic(state, 1e-7 * e),
                  exact = Step(states[static_cast<std::size_t>(state)], 1e-7 * e).stress_change();
      const bool shear = e[2] != 0;
      for (const int k : shear ? std::vector<int>{2} : std::vector<int>{0, 1}) {
        EXPECT_NEAR(expected[k] / measured[k], 1.0, 0.02) << state << ": " << e.transpose() << " " << k;
        EXPECT_NEAR(exact[k] / measured[k], 1.0, 1e-3) << state << ": " << e.transpose() << " " << k;
      }
    }
  }
}

// All main components by columns, forward and back, through the engine. The default tolerance, float and double.
TEST_F(StaticStep, LoadingTangentIsWhatProbesOfItsSizeMeasure) {
  const EngineSettings single;
  for (const int state : {0, 1, 2}) {
    for (const double size : {1e-6, -1e-6, 1e-5, -1e-5}) {
      const Eigen::Matrix3d d = loading(state, size, in_double()), rounded = loading(state, size, single);
      for (int a = 0; a < 3; ++a) {
        const Voigt measured = probe(state, size * Voigt::Unit(a)) / size;
        for (const int b : a == 2 ? std::vector<int>{2} : std::vector<int>{0, 1}) {
          EXPECT_NEAR(d(b, a) / measured[b], 1.0, 0.02) << state << ", " << size << ": " << b << a;
          EXPECT_NEAR(rounded(b, a) / measured[b], 1.0, 0.02) << state << ", " << size << ": " << b << a;
        }
      }
    }
  }
}

// Solved to the end, lanes and dense step are the same numbers, nonsymmetric part and all.
TEST_F(StaticStep, LoadingTangentFollowsTheDenseStep) {
  EngineSettings exact = in_double();
  exact.tangent_tolerance = 1e-9;
  for (const int state : {0, 1, 2}) {
    for (const double size : {1e-6, 1e-5, -1e-5}) {
      const Eigen::Matrix3d d = loading(state, size, exact);
      for (int a = 0; a < 3; ++a) {
        const Step step(states[static_cast<std::size_t>(state)], size * Voigt::Unit(a));
        const double off = (d.col(a) - step.stress_change() / size).cwiseAbs().maxCoeff();
        EXPECT_LT(off, 2e-7 * d.cwiseAbs().maxCoeff()) << state << ", " << size << ": " << a << ", " << step.at_caps();
      }
    }
  }
  const Eigen::Matrix3d d = loading(2, 1e-5, exact);
  EXPECT_GT(std::abs(d(1, 0) - d(0, 1)), 0.1 * d(1, 1)) << "no contact slides: the test shows nothing";
}

TEST_F(StaticStep, NoContactAtRestIsAtItsCapButManyAreNear) {
  int near = 0;
  for (const Spring& s : springs_of(states[1])) {
    const double share = std::abs(s.at.tangential_force) / (s.k.friction * s.at.normal_force);
    EXPECT_LT(share, 1.0 - 1e-6);
    near += share > 1.0 - 1e-3 ? 1 : 0;
  }
  EXPECT_GT(near, 20);
}

// Extension along x goes on as the shear did. The isotropic state is elastic at any of these sizes.
TEST_F(StaticStep, LargerProbesMeasureTheStepWithItsCaps) {
  for (const double size : {1e-6, 1e-5}) {
    EXPECT_NEAR(elastic(0, {size, 0, 0})[0] / probe(0, {size, 0, 0})[0], 1.0, 0.01);
    for (const Voigt& e : {Voigt(size, 0, 0), Voigt(0, -size, 0)}) {
      const Voigt measured = probe(1, e);
      const Step step(states[1], e);
      const int main = e[0] != 0 ? 0 : 1;
      std::printf("strain %.0e along %d: measured %.3f MPa, step %.3f, elastic %.3f; %d contacts at caps\n", size, main,
                  measured[main] / size * 1e-6, step.stress_change()[main] / size * 1e-6,
                  elastic(1, e)[main] / size * 1e-6, step.at_caps());
      EXPECT_NEAR(step.stress_change()[main] / measured[main], 1.0, 0.005);
    }
  }
  EXPECT_GT(elastic(1, {1e-6, 0, 0})[0], 1.1 * probe(1, {1e-6, 0, 0})[0])
      << "no contact reaches its cap: the test shows nothing";
}

}  // namespace
}  // namespace voussoir::kernels
