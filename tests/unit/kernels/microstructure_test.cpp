// Contact networks with known fabric and connectivity; forces against the oracle and against the engine's own stress.
#include "kernels/describe_committed.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "kernels/isa/choose_lanes.hpp"
#include "kernels/state/committed_contacts.hpp"
#include "tests/engine_support.hpp"

namespace voussoir::kernels {
namespace {

using std::numbers::pi;

constexpr MicrostructureRequest everything{.fabric = true, .coordination = true, .strong_networks = true};

Microstructure describe(const std::vector<NetworkContact>& contacts, int grains,
                        const MicrostructureRequest& wanted = everything) {
  Microstructure out;
  describe_network(contacts, grains, wanted, out);
  return out;
}

NetworkContact at_angle(double angle) { return {0, 1, std::cos(angle), std::sin(angle), 1.0}; }

/// Angles whose density is E(theta) = (1 + a cos 2(theta - direction)) / 2 pi: equal shares of its integral.
std::vector<NetworkContact> distributed(double a, double direction, int count) {
  std::vector<NetworkContact> contacts;
  for (int k = 0; k < count; ++k) {
    const double share = 2.0 * pi * (k + 0.5) / count;
    double angle = share;
    for (int iteration = 0; iteration < 200; ++iteration) {  // angle + a/2 sin(2 angle) = share, measured from
                                                             // direction
      angle -= (angle + 0.5 * a * std::sin(2.0 * angle) - share) / (1.0 + a);
    }
    contacts.push_back(at_angle(angle + direction));
  }
  return contacts;
}

TEST(Fabric, OfTheDistributionThatDefinesIt) {
  for (const double direction : {0.3, -1.2, 1.5}) {
    const Microstructure m = describe(distributed(0.4, direction, 1000), 2);
    EXPECT_NEAR(m.fabric_anisotropy, 0.4, 1e-13);
    EXPECT_NEAR(m.fabric_direction, direction, 1e-13);
  }
}

TEST(Fabric, ByHand) {
  EXPECT_NEAR(describe({at_angle(0.7), at_angle(0.7 + pi)}, 2).fabric_anisotropy, 2.0, 1e-15) << "the sense is nothing";
  EXPECT_NEAR(describe({at_angle(0.7), at_angle(0.7 + pi)}, 2).fabric_direction, 0.7, 1e-15);
  // Three along 0.2 and one across: 2 (3 - 1) / 4
  const Microstructure m = describe({at_angle(0.2), at_angle(0.2), at_angle(0.2), at_angle(0.2 + 0.5 * pi)}, 2);
  EXPECT_NEAR(m.fabric_anisotropy, 1.0, 1e-15);
  EXPECT_NEAR(m.fabric_direction, 0.2, 1e-15);
  EXPECT_NEAR(describe({{0, 1, 0.0, 1.0, 1.0}}, 2).fabric_direction, 0.5 * pi, 0.0) << "vertical is +pi/2";
  EXPECT_NEAR(describe({{0, 1, 0.0, -1.0, 1.0}}, 2).fabric_direction, 0.5 * pi, 0.0);
  EXPECT_EQ(describe({}, 2).fabric_anisotropy, 0.0);
}

TEST(Connectivity, ByHand) {
  // A triangle, a grain that hangs on it, a rattler: (2*4 - 1)/(5 - 1 - 1)
  const std::vector<NetworkContact> contacts{{0, 1, 1, 0, 3}, {0, 2, 1, 0, 3}, {1, 2, 1, 0, 5}, {2, 3, 1, 0, 1}};
  const Microstructure m = describe(contacts, 5);
  EXPECT_DOUBLE_EQ(m.coordination, 8.0 / 5.0);
  EXPECT_DOUBLE_EQ(m.mechanical_coordination, 7.0 / 3.0);
  // Mean force 3. Strong at 1: the triangle, 2*3/3. At 2 and 2.5: nothing that touches twice.
  EXPECT_DOUBLE_EQ(m.strong_coordination[0], 2.0);
  EXPECT_EQ(m.strong_coordination[1], 0.0);
  EXPECT_EQ(m.strong_coordination[2], 0.0);
}

TEST(Connectivity, OfStrongNetworksByHand) {
  // Forces 20 (chain 0-1-2-3), 10 (0-4, 4-3), then 18 of 1.
  std::vector<NetworkContact> contacts{
      {0, 1, 1, 0, 20}, {1, 2, 1, 0, 20}, {2, 3, 1, 0, 20}, {0, 4, 1, 0, 10}, {3, 4, 1, 0, 10}};
  for (int k = 5; k < 23; ++k) contacts.push_back({k, k + 1, 1, 0, 1});
  const double mean = 98.0 / 23.0;
  ASSERT_TRUE(2.0 * mean < 10.0 && 10.0 < 2.5 * mean);
  const Microstructure m = describe(contacts, 30);
  EXPECT_DOUBLE_EQ(m.strong_coordination[0], 2.0) << "the ring: 2*5/5";
  EXPECT_DOUBLE_EQ(m.strong_coordination[1], 2.0);
  EXPECT_DOUBLE_EQ(m.strong_coordination[2], 2.0) << "the chain: (2*3 - 2)/(4 - 2)";
  contacts[4].normal_force = 8.0;  // opens the ring at 2: (2*4 - 2)/(5 - 2)
  EXPECT_DOUBLE_EQ(describe(contacts, 30).strong_coordination[1], 2.0);
  contacts.push_back({1, 3, 1, 0, 20});  // a bridge of the chain at 2.5: 4 contacts, grain 0 with one: (8 - 1)/(4 - 1)
  EXPECT_DOUBLE_EQ(describe(contacts, 30).strong_coordination[2], 7.0 / 3.0);
}

TEST(Connectivity, OfAsManyContactsAsAGrainCanHave) {
  constexpr int grains = 65535;  // a grain in the middle of all others; every second contact is strong
  std::vector<NetworkContact> contacts;
  for (int k = 1; k < grains; ++k) contacts.push_back({0, k, 1, 0, k % 2 == 1 ? 3.0 : 1.0});
  const Microstructure m = describe(contacts, grains);
  EXPECT_DOUBLE_EQ(m.mechanical_coordination, grains - 1.0);
  EXPECT_DOUBLE_EQ(m.strong_coordination[0], (grains - 1.0) / 2.0);
  EXPECT_EQ(m.strong_coordination[1], 0.0);
}

TEST(Connectivity, WithoutContactsThereIsNone) {
  const Microstructure m = describe({}, 7);
  EXPECT_EQ(m.coordination, 0.0);
  EXPECT_EQ(m.mechanical_coordination, 0.0);
  for (const double z : m.strong_coordination) EXPECT_EQ(z, 0.0);
}

TEST(Microstructure, WhatIsNotAskedForIsNotComputed) {
  const Microstructure m = describe(distributed(0.4, 0.3, 100), 2, {.coordination = true});
  EXPECT_EQ(m.fabric_anisotropy, 0.0);
  EXPECT_EQ(m.strong_coordination[0], 0.0);
  EXPECT_GT(m.mechanical_coordination, 0.0);
}

/// Committed after an evaluation without motion, so that contacts are listed.
RveBatch settled(reference::Rve rve, std::size_t n) {
  rve.rotations.resize(rve.radii.size(), 0.0);
  RveBatch batch = clones(rve, n);
  (void)run(batch, std::vector<StrainRequest>(n), in_double());
  commit(batch);
  return batch;
}

std::vector<Microstructure> of_committed(const RveBatch& batch) {
  std::vector<CommittedSummary> summaries(batch.size());
  describe_committed(batch, everything, summaries);
  std::vector<Microstructure> out;
  for (const CommittedSummary& s : summaries) out.push_back(s.network);
  return out;
}

TEST(Microstructure, OfAHexagonalLattice) {
  const Microstructure m = of_committed(
      settled(reference::hexagonal_packing(8, 8, 1e-3, 1e-6, reference::Material{}), 1))[0];
  EXPECT_NEAR(m.fabric_anisotropy, 0.0, 1e-14);
  EXPECT_DOUBLE_EQ(m.coordination, 6.0);
  EXPECT_DOUBLE_EQ(m.mechanical_coordination, 6.0);
}

TEST(Microstructure, OfASquareLatticeAndOfRows) {
  reference::Rve rve;
  for (int k = 0; k < 36; ++k) {
    const int column = k % 6, row = k / 6;
    rve.positions.push_back({column * 1.999e-3 + 1e-4, row * 1.999e-3 + 1e-4});
    rve.radii.push_back(1e-3);
    rve.rotations.push_back(k < 18 ? 0.25 : 0.5);
  }
  rve.cell = {6 * 1.999e-3, 0, 0, 6 * 1.999e-3};
  const Microstructure square = of_committed(settled(rve, 1))[0];
  EXPECT_NEAR(square.fabric_anisotropy, 0.0, 1e-14);
  EXPECT_DOUBLE_EQ(square.mechanical_coordination, 4.0);
  EXPECT_DOUBLE_EQ(square.grain_rotation, 0.375);
  rve.cell.yy *= 1.2;  // rows along x, apart
  for (auto& x : rve.positions) x.y *= 1.2;
  const Microstructure rows = of_committed(settled(rve, 1))[0];
  EXPECT_NEAR(rows.fabric_anisotropy, 2.0, 1e-14);
  EXPECT_NEAR(rows.fabric_direction, 0.0, 1e-14);
  EXPECT_DOUBLE_EQ(rows.mechanical_coordination, 2.0);
}

class OfAPacking : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    sheared = reference::consolidated_packing(60, 4, 1e5, 0.1, reference::Material{});
    strain(sheared, {1.004, 0.006, 0, 0.99}, {.steps = 6000, .hold_steps = 500});
  }
  static inline reference::Rve sheared;
};

TEST_F(OfAPacking, ForcesAreTheOracles) {
  const RveBatch batch = clones(sheared, 1);
  std::vector<CommittedContact> contacts;
  committed_contacts(batch, 0, contacts);
  const auto expected = reference::contacts(sheared);
  ASSERT_EQ(contacts.size(), expected.size());
  double largest = 0, slid = 0;
  for (const auto& c : expected) largest = std::max(largest, c.normal_force);
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    EXPECT_EQ(contacts[c].i, expected[c].i);
    EXPECT_EQ(contacts[c].j, expected[c].j);
    EXPECT_NEAR(contacts[c].normal_force, expected[c].normal_force, 2e-12 * largest);
    EXPECT_NEAR(contacts[c].tangential_force, expected[c].tangential_force, 2e-12 * largest);
    EXPECT_NEAR(contacts[c].moment, expected[c].moment, 2e-15 * largest);
    slid = std::max(slid, std::abs(expected[c].tangential_force));
  }
  EXPECT_GT(slid, 0.1 * largest) << "no tangential force: the test shows nothing";
}

/// The network of an RVE by a set of lanes, against the contacts one by one.
void expect_network_of_contacts(const LaneSet& set, const RveBatch& batch, std::size_t rve) {
  SCOPED_TRACE(name_of(set.isa));
  std::vector<CommittedContact> contacts;
  committed_contacts(batch, rve, contacts);
  std::vector<NetworkContact> network(7);
  set.committed_network(batch, rve, network);
  ASSERT_EQ(network.size(), contacts.size());
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    EXPECT_EQ(network[c].i, contacts[c].i);
    EXPECT_EQ(network[c].j, contacts[c].j);
    EXPECT_EQ(network[c].normal_x, contacts[c].normal_x) << c;
    EXPECT_EQ(network[c].normal_y, contacts[c].normal_y) << c;
    EXPECT_EQ(network[c].normal_force, contacts[c].normal_force) << c;
  }
}

TEST_F(OfAPacking, NetworksHaveTheBitsOfTheContactsInEverySet) {
  RveBatch of_one_class = clones(sheared, 2), of_classes = clones(sheared, 2);
  of_classes.packings[0].materials.push_back({.modulus = 7.0e8});
  of_classes.packings[0].class_of.resize(sheared.radii.size());
  for (std::size_t i = 0; i < sheared.radii.size(); i += 3) of_classes.packings[0].class_of[i] = 1;
  of_one_class.committed.contact_count(0) = 0;
  const RveBatch of_many_contacts = settled(reference::hexagonal_packing(9, 6, 1e-3, 1e-6, reference::Material{}), 1);
  ASSERT_GT(of_many_contacts.committed.contact_count(0), 128) << "they are to be read in several blocks";
  for (const LaneSet* set : compiled_lanes()) {
    if (set->isa > processor_set()) continue;
    choose_lanes(set->isa);
    for (const std::size_t rve : {std::size_t{0}, std::size_t{1}}) {
      expect_network_of_contacts(*set, of_one_class, rve);
      expect_network_of_contacts(*set, of_classes, rve);
    }
    expect_network_of_contacts(*set, of_many_contacts, 0);
  }
  choose_lanes({});
}

TEST_F(OfAPacking, ForcesGiveTheReportedStress) {
  RveBatch batch = clones(sheared, 1);
  const RveReport report = run(batch, {StrainRequest{}}, in_double()).front();
  commit(batch);
  std::vector<CommittedContact> contacts;
  committed_contacts(batch, 0, contacts);
  const double volume = reference::det(sheared.cell) * sheared.material.thickness;
  double stress[4] = {};
  for (const CommittedContact& c : contacts) {
    stress[0] += c.force_x() * c.branch_x / volume;
    stress[1] += c.force_x() * c.branch_y / volume;
    stress[2] += c.force_y() * c.branch_x / volume;
    stress[3] += c.force_y() * c.branch_y / volume;
  }
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(stress[k], report.stress[k], 1e-12 * report.pressure()) << k;
}

TEST_F(OfAPacking, AShearedOneHasMoreContactsAlongTheCompression) {
  const Microstructure m = of_committed(clones(sheared, 1))[0];
  EXPECT_GT(m.fabric_anisotropy, 0.05);
  EXPECT_GT(std::abs(m.fabric_direction), 0.25 * pi) << "y is compressed";
  EXPECT_GE(m.mechanical_coordination, m.coordination);
  EXPECT_NEAR(m.grain_rotation, reference::mean_rotation(sheared), 1e-15);
}

TEST_F(OfAPacking, SameBitsAnywhereInTheBatch) {
  const auto all = of_committed(clones(sheared, 37));
  for (const Microstructure& m : all) {
    EXPECT_EQ(m.fabric_anisotropy, all[0].fabric_anisotropy);
    EXPECT_EQ(m.strong_coordination, all[0].strong_coordination);
  }
}

struct Compression {
  std::vector<std::vector<ServoSample>> traces;
  RveBatch batch;
};

/// Biaxial compression of copies of a packing, sampled along the way.
Compression compress(const reference::Rve& rve, const MicrostructureRequest& wanted, Precision precision) {
  Compression out{std::vector<std::vector<ServoSample>>(3), clones(rve, 3)};
  std::vector<ServoRequest> requests;
  for (std::size_t k = 0; k < 3; ++k) {
    requests.push_back({.x = {.target = -1e5},
                        .y = {.stress_controlled = false, .target = -1e-6 * (1.0 + static_cast<double>(k))},
                        .end_strain_y = 2e-3,
                        .trace = &out.traces[k],
                        .trace_interval = 50,
                        .microstructure = wanted});
  }
  std::vector<RveReport> reports(3);
  EngineSettings settings = in_double();
  settings.precision = precision;
  advance(out.batch, std::span<const ServoRequest>(requests), settings, reports);
  commit(out.batch);
  return out;
}

TEST_F(OfAPacking, RecordedAlongAPathItIsTheSameAndChangesNothing) {
  for (const Precision precision : {Precision::float32, Precision::float64}) {
    const Compression with = compress(sheared, everything, precision), without = compress(sheared, {}, precision);
    const Microstructure start = of_committed(clones(sheared, 1))[0];
    const auto end = of_committed(with.batch);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto &a = with.traces[k], &b = without.traces[k];
      ASSERT_EQ(a.size(), b.size());
      ASSERT_GT(a.size(), 10u);
      for (std::size_t s = 0; s < a.size(); ++s) {
        EXPECT_EQ(a[s].stress_yy, b[s].stress_yy);
        EXPECT_EQ(b[s].microstructure.coordination, 0.0);
        EXPECT_GT(a[s].microstructure.coordination, 1.0);
      }
      // The first sample is one step from the start, of 3e-6 strain: branches have turned, no contact has changed.
      EXPECT_NEAR(a[0].microstructure.fabric_anisotropy, start.fabric_anisotropy, 1e-5);
      EXPECT_EQ(a[0].microstructure.mechanical_coordination, start.mechanical_coordination);
      EXPECT_EQ(a[0].microstructure.strong_coordination[1], start.strong_coordination[1]);
      EXPECT_EQ(a[0].microstructure.grain_rotation, 0.0);
      // The last sample is at most 50 of some 1000 steps before the end: few contacts have changed.
      EXPECT_NEAR(a.back().microstructure.fabric_anisotropy, end[k].fabric_anisotropy, 0.05);
      EXPECT_NEAR(a.back().microstructure.grain_rotation, end[k].grain_rotation - start.grain_rotation, 1e-4);
    }
  }
}

}  // namespace
}  // namespace voussoir::kernels
