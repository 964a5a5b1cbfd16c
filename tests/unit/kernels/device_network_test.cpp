// What a device says of its committed states is what the host says of them, bit by bit, and no state comes down for it.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kernels/advance_rves.hpp"
#include "kernels/describe_committed.hpp"
#include "kernels/device/device_residence.hpp"
#include "tests/device_blocks.hpp"
#include "tests/tiled_packing.hpp"

namespace voussoir::kernels {
namespace {

constexpr MicrostructureRequest everything{.fabric = true, .coordination = true, .strong_networks = true};

/// All combinations of what can be asked for.
std::vector<MicrostructureRequest> requests() {
  std::vector<MicrostructureRequest> out;
  for (int k = 0; k < 8; ++k)
    out.push_back({.fabric = (k & 1) != 0, .coordination = (k & 2) != 0, .strong_networks = (k & 4) != 0});
  return out;
}

std::vector<Blocks> all_blocks() {
  std::vector<Blocks> out{{}};
  for (const int threads : {1, 2, 7, 32, 128}) out.push_back({BlockKind::in_memory, threads});
  out.push_back({BlockKind::in_registers, 7});
  return out;
}

class DeviceNetwork : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    sheared = reference::consolidated_packing(60, 4, 1e5, 0.1, reference::Material{});
    strain(sheared, {1.004, 0.006, 0, 0.99}, {.steps = 3000, .hold_steps = 200});
    for (std::size_t i = 0; i < sheared.radii.size(); ++i) sheared.rotations[i] = 0.01 * static_cast<double>(i) / 7.0;
  }
  static inline reference::Rve sheared;
};

void expect_same(double a, double b, const char* what, std::size_t rve) {
  if (std::isnan(a) && std::isnan(b)) return;
  EXPECT_EQ(a, b) << what << " of RVE " << rve;
}
void expect_same(const std::vector<CommittedSummary>& a, const std::vector<CommittedSummary>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    const Microstructure &x = a[k].network, &y = b[k].network;
    expect_same(a[k].cell_area, b[k].cell_area, "the area", k);
    expect_same(x.grain_rotation, y.grain_rotation, "the rotation", k);
    expect_same(x.coordination, y.coordination, "the coordination", k);
    expect_same(x.fabric_anisotropy, y.fabric_anisotropy, "the fabric", k);
    expect_same(x.fabric_direction, y.fabric_direction, "the direction", k);
    expect_same(x.mechanical_coordination, y.mechanical_coordination, "the mechanical coordination", k);
    for (std::size_t q = 0; q < strong_thresholds.size(); ++q)
      expect_same(x.strong_coordination[q], y.strong_coordination[q], "a strong coordination", k);
  }
}

std::vector<CommittedSummary> described(const RveBatch& batch, const MicrostructureRequest& wanted) {
  std::vector<CommittedSummary> out(batch.size());
  describe_committed(batch, wanted, out);
  return out;
}

/// Moves a batch to a device that takes its states for newer ones than the host's.
void move_to(RveBatch& batch, const Blocks& blocks, Precision precision = Precision::float32) {
  device::reside(batch, std::make_shared<BlockDevice>(blocks), precision);
  commit(batch);
  ASSERT_TRUE(batch.residence->is_ahead());
}

/// Describes the states that `make` gives by host and by device. Returns what the host says when all is asked for.
template <class Make>
std::vector<CommittedSummary> expect_hosts_bits(const Make& make, const std::vector<Blocks>& kinds) {
  const RveBatch host = make();
  for (const Precision precision : {Precision::float32, Precision::float64}) {
    for (const Blocks& blocks : kinds) {
      SCOPED_TRACE(name_of(blocks));
      RveBatch batch = make();
      move_to(batch, blocks, precision);
      for (const MicrostructureRequest& wanted : requests()) {
        expect_same(described(batch, wanted), described(host, wanted));
        EXPECT_TRUE(batch.residence->is_ahead()) << "the states came down";
      }
    }
  }
  return described(host, everything);
}

TEST_F(DeviceNetwork, HasTheHostsBitsForAnyNumberOfThreads) {
  const auto found = expect_hosts_bits([] { return clones(sheared, 3); }, all_blocks());
  EXPECT_GT(found[0].network.fabric_anisotropy, 0.05);
  EXPECT_GT(found[0].network.grain_rotation, 0.01);
  EXPECT_GT(found[0].network.strong_coordination[0], 1.0);
  EXPECT_NE(found[0].network.strong_coordination[0], found[0].network.mechanical_coordination);
}

TEST_F(DeviceNetwork, HasTheHostsBitsForOddStates) {
  // RVE 1 has no contacts, and RVE 3 a position that is not a number; the cell of RVE 4 is another one.
  const auto found = expect_hosts_bits(
      [] {
        RveBatch batch = clones(sheared, 6);
        batch.committed.contact_count(1) = 0;
        batch.committed.position(3, 7, 1) = std::numeric_limits<double>::quiet_NaN();
        batch.committed.cell(4, 1) += 0.01 * batch.committed.cell(4, 0);
        return batch;
      },
      {{}, {BlockKind::in_memory, 7}});
  EXPECT_EQ(found[1].network.mechanical_coordination, 0.0);
  EXPECT_TRUE(std::isnan(found[3].network.fabric_anisotropy));
  EXPECT_NE(found[4].network.fabric_anisotropy, found[0].network.fabric_anisotropy);
  EXPECT_EQ(found[5].network.fabric_anisotropy, found[0].network.fabric_anisotropy);
}

TEST_F(DeviceNetwork, HasTheHostsBitsForClassesAndUnlikePackings) {
  // The two packings have unlike grains and numbers of grains; those of one are of two classes.
  const reference::Rve other = reference::consolidated_packing(40, 2, 1e5, 0.0, reference::Material{});
  const auto make = [&](double modulus) {
    std::vector<Packing> packings{packing_of(sheared), packing_of(other)};
    packings[1].materials.push_back({.modulus = modulus});
    packings[1].class_of.resize(other.radii.size());
    for (std::size_t i = 0; i < other.radii.size(); i += 3) packings[1].class_of[i] = 1;
    RveBatch batch = make_batch(std::move(packings), {0, 1, 1, 0});
    for (const std::size_t k : {0, 3}) fill(batch.committed, k, sheared);
    for (const std::size_t k : {1, 2}) fill(batch.committed, k, other);
    return batch;
  };
  const auto soft = expect_hosts_bits([&] { return make(3.0e7); }, {{}, {BlockKind::in_memory, 7}});
  const auto alike = described(make(GrainMaterial{}.modulus), everything);
  EXPECT_NE(soft[1].network.strong_coordination, alike[1].network.strong_coordination) << "classes do not matter";
}

TEST_F(DeviceNetwork, HasTheHostsBitsWhereAllForcesAreEqual) {
  // Each force is the mean one but for rounding, so that rounding decides which contacts are strong.
  const reference::Rve lattice = reference::hexagonal_packing(9, 6, 1e-3, 1e-6, reference::Material{});
  const auto make = [&] {
    reference::Rve rve = lattice;
    rve.rotations.resize(rve.radii.size(), 0.0);
    RveBatch batch = clones(rve, 1);
    (void)run(batch, std::vector<StrainRequest>(1), in_double());
    commit(batch);
    return batch;
  };
  EXPECT_EQ(expect_hosts_bits(make, all_blocks())[0].network.mechanical_coordination, 6.0);
}

TEST_F(DeviceNetwork, HasTheHostsBitsForSevenHundredGrains) {
  const reference::Rve tile = reference::consolidated_packing(50, 3, 1e5, 0.0, reference::Material{});
  const reference::Rve rve = reference::tiled(tile, 2, 7);
  const auto found = expect_hosts_bits([&] { return clones(rve, 2); },
                                       {{}, {BlockKind::in_memory, 7}, {BlockKind::in_memory, 32}});
  EXPECT_GT(found[0].network.coordination, 3.0);
}

TEST_F(DeviceNetwork, IsThatOfTheCommittedStates) {
  // RVE 1 is kept back at the first commit and RVE 2 at the second; a trial state says nothing.
  constexpr std::size_t n = 4;
  RveBatch batch = clones(sheared, n);
  move_to(batch, {BlockKind::in_memory, 3}, Precision::float64);
  const auto start = described(batch, everything);
  std::vector<std::vector<CommittedSummary>> said;
  for (const int kept : {1, 2}) {
    (void)run(batch, motions(n), in_double());
    expect_same(described(batch, everything), said.empty() ? start : said.back());
    commit(batch, std::array{kept});
    said.push_back(described(batch, everything));
  }
  EXPECT_EQ(said[0][1].cell_area, start[1].cell_area);
  EXPECT_EQ(said[1][2].cell_area, said[0][2].cell_area);
  for (const std::size_t k : {0, 3}) EXPECT_NE(said[1][k].cell_area, said[0][k].cell_area);
  // The host says the same of the states that come down.
  bring_committed(batch);
  forget_candidates(batch);
  ASSERT_FALSE(batch.residence->has_committed());
  expect_same(described(batch, everything), said[1]);
}

TEST_F(DeviceNetwork, BringsNoStates) {
  constexpr std::size_t n = 5;
  RveBatch batch = clones(sheared, n);
  device::reside(batch, std::make_shared<BlockDevice>(Blocks{}), Precision::float32);
  const auto down = [&] { return device::device_work(batch).bytes_down; };
  const std::size_t of_rve = device::bytes_of_rve(device::plain(batch.committed));
  const double before = batch.committed.position(2, 3, 0);
  (void)run(batch, motions(n), {});
  const std::size_t evaluated = down();
  EXPECT_EQ(evaluated, n * (sizeof(RveReport) + 1));
  commit(batch);
  (void)described(batch, everything);
  EXPECT_EQ(down() - evaluated, n * (25 + sizeof(CommittedSums)));
  EXPECT_LT(down() + device::device_work(batch).bytes_up, n * of_rve / 10);
  EXPECT_EQ(batch.committed.position(2, 3, 0), before) << "a state came down";
  // One RVE, and then all of them: once.
  const std::size_t described_all = down();
  bring_committed(batch, 2);
  EXPECT_NE(batch.committed.position(2, 3, 0), before);
  EXPECT_EQ(batch.committed.position(1, 3, 0), before) << "another RVE came down";
  EXPECT_EQ(down() - described_all, of_rve);
  bring_committed(batch);
  EXPECT_NE(batch.committed.position(1, 3, 0), before);
  EXPECT_EQ(down() - described_all, (1 + n) * of_rve);
  bring_committed(batch);
  bring_committed(batch, 2);
  EXPECT_EQ(down() - described_all, (1 + n) * of_rve);
  // The states go up again where the host has changed them.
  const std::size_t up = device::device_work(batch).bytes_up;
  forget_candidates(batch);
  (void)run(batch, motions(n), {});
  EXPECT_GE(device::device_work(batch).bytes_up - up, n * of_rve);
}

}  // namespace
}  // namespace voussoir::kernels
