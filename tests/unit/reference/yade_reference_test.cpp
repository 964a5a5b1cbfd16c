// One packing as Yade computed it, 700 grains at 100 kPa (tests/data/yade): the oracle rebuilds its contacts,
// stiffnesses, stress and tangent grain by grain, and so does the engine.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <string>

#include "kernels/state/committed_contacts.hpp"
#include "tests/engine_support.hpp"

namespace voussoir::reference {
namespace {

const std::filesystem::path data = std::filesystem::path(VOUSSOIR_SOURCE_DIR) / "tests/data/yade";

/// Rows of a CSV file of numbers, each by column name.
std::vector<std::map<std::string, double>> read_table(const std::string& name) {
  std::ifstream file(data / name);
  std::string line, word;
  std::getline(file, line);
  std::vector<std::string> names;
  for (std::istringstream head(line); std::getline(head, word, ',');) names.push_back(word);
  std::vector<std::map<std::string, double>> rows;
  while (std::getline(file, line)) {
    auto& row = rows.emplace_back();
    std::size_t k = 0;
    for (std::istringstream cells(line); std::getline(cells, word, ',');) row[names.at(k++)] = std::stod(word);
  }
  return rows;
}

/// The `count` numbers that follow "key" in the meta file, brackets skipped.
std::vector<double> read_meta(const std::string& key, std::size_t count) {
  std::ifstream file(data / "CPS_D_meta.json");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::size_t at = text.find('"' + key + '"');
  if (at == std::string::npos) throw std::runtime_error("no " + key + " in the meta file");
  std::vector<double> values;
  const char* cursor = text.c_str() + at + key.size() + 2;
  while (values.size() < count && *cursor != '\0') {
    char* end = nullptr;
    const double value = std::strtod(cursor, &end);
    if (end != cursor) values.push_back(value);
    cursor = end != cursor ? end : cursor + 1;
  }
  return values;
}

/// Yade's own record of a contact in our signs: its Fn, Fs act on id2, its Mz on id2, ours on i = id1.
struct Record {
  Vec2 normal;
  double overlap, kn, kt, kr, fn, ft, moment, rolling_arm;
};

class YadeReference : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const auto h = read_meta("hSize", 9);
    rve.cell = {h.at(0), h.at(1), h.at(3), h.at(4)};
    rve.material = {.modulus = read_meta("E", 1).at(0),
                    .stiffness_ratio = read_meta("kt_over_kn", 1).at(0),
                    .friction = std::tan(read_meta("phi_deg", 1).at(0) * std::numbers::pi / 180),
                    .rolling_stiffness = read_meta("alphaKr", 1).at(0),
                    .rolling_limit = read_meta("etaRoll", 1).at(0),
                    .damping = read_meta("damping", 1).at(0),
                    .thickness = read_meta("Lz", 1).at(0)};
    for (auto& row : read_table("CPS_D_particles.csv")) {
      rve.positions.push_back({row["x_m"], row["y_m"]});
      rve.radii.push_back(row["r_m"]);
      rve.rotations.push_back(row["theta_z_rad"]);
    }
    for (auto& row : read_table("CPS_D_contacts.csv")) {
      const Vec2 n{row["nx"], row["ny"]};
      const Record record{n,
                          row["overlap_m"],
                          row["kn"],
                          row["ks"],
                          row["kr"],
                          dot({row["Fn_x"], row["Fn_y"]}, n),
                          -dot({row["Fs_x"], row["Fs_y"]}, left_of(n)),
                          -row["Mz"],
                          row["maxRollPl"]};
      const std::pair key{static_cast<int>(row["id1"]), static_cast<int>(row["id2"])};
      records[key] = record;
      rve.histories[key] = {.tangential = record.ft, .moment = record.moment};
    }
    touching = contacts(rve);
  }

  static inline Rve rve;
  static inline std::map<std::pair<int, int>, Record> records;
  static inline std::vector<Contact> touching;
};

TEST_F(YadeReference, FindsExactlyItsContacts) {
  ASSERT_EQ(rve.positions.size(), 700u);
  ASSERT_EQ(records.size(), static_cast<std::size_t>(read_meta("n_contacts", 1).at(0)));
  ASSERT_EQ(touching.size(), records.size());
  for (const Contact& c : touching) EXPECT_TRUE(records.contains({c.i, c.j})) << c.i << ' ' << c.j;
}

TEST_F(YadeReference, GeometryAndConstants) {
  for (const Contact& c : touching) {
    const Record& yade = records.at({c.i, c.j});
    const PairStiffness k = pair_stiffness(rve.material, rve.radii[c.i], rve.radii[c.j]);
    // The positions were written one step after the overlaps; that step moved a pair by up to 4.7e-10 m. Typical
    // overlap: 4e-6 m.
    EXPECT_NEAR(c.overlap, yade.overlap, 5e-10);
    EXPECT_NEAR(c.normal.x, yade.normal.x, 5e-7);
    EXPECT_NEAR(c.normal.y, yade.normal.y, 5e-7);
    EXPECT_NEAR(k.normal, yade.kn, 1e-13 * yade.kn);
    EXPECT_NEAR(k.tangential, yade.kt, 1e-13 * yade.kt);
    EXPECT_NEAR(k.rolling, yade.kr, 1e-13 * yade.kr);
    EXPECT_NEAR(rve.material.rolling_limit * std::min(rve.radii[c.i], rve.radii[c.j]), yade.rolling_arm, 1e-16);
    EXPECT_NEAR(yade.fn, k.normal * yade.overlap, 1e-13 * yade.fn);
  }
}

TEST_F(YadeReference, LoveWeberStressFromItsForces) {
  std::vector<Contact> with_its_forces = touching;
  for (Contact& c : with_its_forces) {
    const Record& yade = records.at({c.i, c.j});
    c.normal_force = yade.fn;
    c.tangential_force = yade.ft;
  }
  const Mat2 sigma = love_weber(rve, with_its_forces);
  const auto expected = read_meta("stress", 9);
  const double tolerance = 1e-8 * read_meta("P0", 1).at(0);
  EXPECT_NEAR(sigma.xx, expected.at(0), tolerance);
  EXPECT_NEAR(sigma.xy, expected.at(1), tolerance);
  EXPECT_NEAR(sigma.yx, expected.at(3), tolerance);
  EXPECT_NEAR(sigma.yy, expected.at(4), tolerance);
}

TEST_F(YadeReference, LoveWeberStressFromItsPositions) {
  const Voigt sigma = stress(rve);
  const auto expected = read_meta("stress", 9);
  const double tolerance = 1e-5 * read_meta("P0", 1).at(0);  // positions are one step younger, see above
  EXPECT_NEAR(sigma[0], expected.at(0), tolerance);
  EXPECT_NEAR(sigma[1], expected.at(4), tolerance);
  EXPECT_NEAR(sigma[2], 0.5 * (expected.at(1) + expected.at(3)), tolerance);
}

TEST_F(YadeReference, Tangent) {
  // The file holds the upper triangle, Voigt order (xx, yy, zz, yz, zx, xy), minor symmetries imposed: xyxy is
  // sum k_t |b|^2 ((n t + t n)/2)_xy^2 + ..., to be multiplied by the engineering shear strain, as ours.
  const auto d6 = read_meta("tangent6x6", 36);
  const VoigtMatrix d = tangent(rve);
  const double tolerance = 1e-8 * d6.at(0);
  const std::array<std::size_t, 3> place{0, 1, 5};
  for (std::size_t p = 0; p < 3; ++p) {
    for (std::size_t q = p; q < 3; ++q) {
      EXPECT_NEAR(d[p][q], d6.at(6 * place[p] + place[q]), tolerance) << p << q;
      EXPECT_NEAR(d[p][q], d[q][p], 1e-14 * d6.at(0));
    }
  }
}

TEST_F(YadeReference, EngineRebuildsStressAndTangent) {
  kernels::RveBatch batch = kernels::clones(rve, 1);
  std::vector<kernels::CommittedContact> rebuilt;
  kernels::committed_contacts(batch, 0, rebuilt);
  ASSERT_EQ(rebuilt.size(), records.size());
  Mat2 with_its_forces, from_positions;
  const double volume = det(rve.cell) * rve.material.thickness;
  for (kernels::CommittedContact& c : rebuilt) {
    const auto add = [&](Mat2& sigma) {
      sigma.xx += c.force_x() * c.branch_x / volume;
      sigma.xy += c.force_x() * c.branch_y / volume;
      sigma.yx += c.force_y() * c.branch_x / volume;
      sigma.yy += c.force_y() * c.branch_y / volume;
    };
    add(from_positions);
    const Record& yade = records.at({c.i, c.j});
    c.normal_force = yade.fn;
    c.tangential_force = yade.ft;
    add(with_its_forces);
  }
  const auto expected = read_meta("stress", 9);
  const double p0 = read_meta("P0", 1).at(0);
  for (const auto& [sigma, tolerance] : {std::pair{with_its_forces, 1e-8 * p0}, std::pair{from_positions, 1e-5 * p0}}) {
    EXPECT_NEAR(sigma.xx, expected.at(0), tolerance);
    EXPECT_NEAR(0.5 * (sigma.xy + sigma.yx), 0.5 * (expected.at(1) + expected.at(3)), tolerance);
    EXPECT_NEAR(sigma.yy, expected.at(4), tolerance);
  }
  const kernels::RveReport report = run(batch, {kernels::StrainRequest{}}, kernels::in_double()).front();
  const auto d6 = read_meta("tangent6x6", 36);
  const std::size_t place[6] = {0, 1, 5, 7, 11, 35};  // xxxx, xxyy, xxxy, yyyy, yyxy, xyxy
  for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(report.tangent[k], d6.at(place[k]), 1e-8 * d6.at(0)) << k;
}

TEST_F(YadeReference, IsAtRestForTheOracle) {
  // Yade reports 3.5e-6 by its own measure (largest resultant over mean contact force).
  Rve copy = rve;
  EXPECT_LT(step(copy, Mat2{}, Mat2{}).unbalanced_ratio, 1e-4);
}

}  // namespace
}  // namespace voussoir::reference
