// RVEs as the material of a mesh: the number of steps that an increment gets, and what a snapshot shows.
#include "host/material/rve_pool.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "host/case/accuracy.hpp"
#include "io/input_error.hpp"
#include "tests/host_support.hpp"

namespace voussoir::host {
namespace {

/// The steps are the smallest number of the series ceil(1.25^k) that is not below the wanted number.
void expect_steps_of_the_series(const EngineCase& engine) {
  const PackedRve rve = small_packing();
  RvePool pool(rve, {.engine = engine}, 1);
  const double time = rve.packing.inertial_time(pool.committed_reports()[0].pressure());
  std::vector<fem::Stress> stress(1);
  for (const double strain : {1e-7, 1e-5, 3e-5, 1e-4, 3e-4, 1e-3}) {
    fem::Gradient h = fem::Gradient::Zero();
    h(0, 0) = -strain;
    pool.begin_increment();
    ASSERT_TRUE(pool.evaluate({&h, 1}, stress, {}).usable);
    const double wanted = -std::log1p(-strain) / inertial_number_at(time, engine) * time;
    double power = 1;
    while (power < wanted) power *= 1.25;
    // The engine looks at the forces once more where the hold would begin, which counts as a step.
    EXPECT_EQ(pool.trial_reports()[0].steps, static_cast<int>(std::ceil(power)) + 1) << strain;
  }
}

TEST(RvePool, StepsAreTheNextOfTheirSeries) {
  EngineCase engine;
  engine.hold_cap = 0;
  engine.minimum_steps = 1;
  expect_steps_of_the_series(engine);
  engine.accuracy = 0.002;  // finer than the preset at this pressure
  ASSERT_LT(inertial_number_at(small_packing().packing.inertial_time(small_packing().pressure), engine),
            0.9 * engine.inertial_number);
  expect_steps_of_the_series(engine);
}

TEST(RvePool, TellsTheTimeOfTheTangentsThatAreWanted) {
  RvePool pool(small_packing(), {.engine = {}, .tangent = kernels::TangentKind::elastic}, 1);
  const fem::Gradient none = fem::Gradient::Zero();
  std::vector<fem::Stress> stress(1);
  std::vector<fem::Tangent> tangent(1);
  EXPECT_GT(pool.evaluate({&none, 1}, stress, tangent).tangent_time, 0.0);
  EXPECT_EQ(pool.evaluate({&none, 1}, stress, {}).tangent_time, 0.0);
}

TEST(RvePool, ASnapshotShowsTheGrainsWhereTheyAre) {
  const PackedRve rve = small_packing();
  const RvePool pool(rve, {}, 2);
  const std::vector<std::int64_t> points{1};
  const io::RveSnapshot shown = pool.snapshots(points).at(0);
  ASSERT_EQ(shown.x.size(), rve.packing.radii.size());
  for (std::size_t i = 0; i < shown.x.size(); ++i) {
    EXPECT_EQ(shown.x[i], rve.position[2 * i]);
    EXPECT_EQ(shown.y[i], rve.position[2 * i + 1]);
    EXPECT_EQ(shown.radius[i], rve.packing.radii[i]);
  }
}

std::vector<std::byte> bytes_of(const fem::HeldState& held) {
  std::vector<std::byte> bytes;
  held.write([&](std::span<const std::byte> piece) { bytes.insert(bytes.end(), piece.begin(), piece.end()); });
  EXPECT_EQ(held.size(), bytes.size());
  return bytes;
}

class HeldState : public testing::TestWithParam<double> {
 protected:
  HeldState() {
    EngineCase engine;
    engine.defer = GetParam();
    engine.hold_cap = 300;
    for (auto* pool : {&pool_, &copied_}) *pool = std::make_unique<RvePool>(small_packing(), PoolOptions{engine}, 3);
  }

  /// The first RVE is strained so little that it is deferred where RVEs may be.
  static void advance(RvePool& pool, int increments) {
    std::vector<fem::Gradient> h(3, fem::Gradient::Zero());
    for (std::size_t k = 0; k < 3; ++k) h[k](1, 1) = -1e-7 * std::pow(50.0, static_cast<double>(k));
    std::vector<fem::Stress> stress(3);
    std::vector<fem::Tangent> tangent(3);
    for (int n = 0; n < increments; ++n) {
      pool.begin_increment();
      ASSERT_TRUE(pool.evaluate(h, stress, tangent).usable);
      pool.commit();
    }
  }

  std::unique_ptr<RvePool> pool_, copied_;
};

TEST_P(HeldState, StaysWhatItIs) {
  advance(*pool_, 1);
  const std::shared_ptr<const fem::HeldState> held = pool_->hold();
  const std::vector<std::byte> then = pool_->state();
  EXPECT_EQ(bytes_of(*held), then);
  for (int commits = 1; commits <= 4; ++commits) {
    advance(*pool_, 1);
    EXPECT_EQ(bytes_of(*held), then) << commits;
    EXPECT_NE(pool_->state(), then);
  }
}

/// Holding changes no bit of what follows, whether the state is let go at once, late, or gone back to.
TEST_P(HeldState, ChangesNothingOfWhatFollows) {
  std::shared_ptr<const fem::HeldState> held;
  for (int n = 0; n < 4; ++n) {
    const std::shared_ptr<const fem::HeldState> before = pool_->hold();
    const std::vector<std::byte> copy = copied_->state();
    advance(*pool_, 2);
    advance(*copied_, 2);
    pool_->return_to(*before);
    copied_->set_state(copy);
    EXPECT_EQ(pool_->state(), copy);
    held = n % 2 == 0 ? before : nullptr;
    advance(*pool_, 1);
    advance(*copied_, 1);
    EXPECT_EQ(pool_->state(), copied_->state()) << n;
  }
}

/// One wrong bit anywhere is seen, also within numbers that could be right.
TEST_P(HeldState, IsRefusedWhereOneBitIsWrong) {
  EngineCase engine;
  engine.defer = GetParam();
  RvePool pool(small_packing(), PoolOptions{engine}, 1);
  const std::vector<std::byte> good = pool.state();
  std::vector<std::byte> bytes = good;
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    const auto flip = std::byte{1} << (bit % 8);
    bytes[bit / 8] ^= flip;
    ASSERT_THROW(pool.set_state(bytes), std::runtime_error) << "bit " << bit << " of " << 8 * bytes.size();
    bytes[bit / 8] ^= flip;
  }
  EXPECT_EQ(pool.state(), good);
}

TEST_P(HeldState, OfAnEarlierVersionIsRefused) {
  std::vector<std::byte> bytes = pool_->state();
  bytes[0] = std::byte{record_version - 1};
  try {
    pool_->set_state(bytes);
    FAIL() << "it was taken";
  } catch (const io::InputError& fault) {
    EXPECT_NE(std::string(fault.what()).find("another version of this program"), std::string::npos) << fault.what();
  }
}

/// Records whose checksums are right and whose contacts are impossible: nothing of the RVEs before is taken over.
TEST_P(HeldState, IsRefusedWhereAContactIsImpossible) {
  const std::vector<std::byte> then = pool_->state();
  advance(*pool_, 1);
  const std::vector<std::byte> now = pool_->state();
  std::vector<StateRecord> records = split_state(then, pool_->identity(), 3);
  std::vector<std::byte> wrong(records[2].begin(), records[2].end());
  std::fill(wrong.end() - wrong.size() / 2, wrong.end(), std::byte{0xff});
  records[2] = wrong;
  EXPECT_THROW(pool_->set_state(join_state(pool_->identity(), records)), std::runtime_error);
  EXPECT_EQ(pool_->state(), now);
}

/// A state of another moment cannot be written over one that is held.
TEST_P(HeldState, IsNotWrittenOver) {
  const std::vector<std::byte> first = pool_->state();
  advance(*pool_, 1);
  std::shared_ptr<const fem::HeldState> held = pool_->hold();
  EXPECT_THROW(pool_->set_state(first), std::logic_error);
  held.reset();
  pool_->set_state(first);
  EXPECT_EQ(pool_->state(), first);
}

INSTANTIATE_TEST_SUITE_P(WithAndWithoutDeferral, HeldState, testing::Values(0.0, 1e-2));

}  // namespace
}  // namespace voussoir::host
