// Packings: the recipe's targets, the same bits whoever is made beside them, the cache and its damage.

#include "host/packing/packings.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "host/material/rve_pool.hpp"
#include "host/packing/recipe.hpp"
#include "tests/throws.hpp"

namespace voussoir::host {
namespace {

class HostPacking : public testing::Test {
 protected:
  void SetUp() override {
    const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    folder_ = std::filesystem::temp_directory_path() / ("voussoir_packing_" + name + "_" + std::to_string(getpid()));
    std::filesystem::remove_all(folder_);
    input_.packing.grains = 60;
    input_.packing.pressure = 1.0e4;
    input_.packing.folder = folder_;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
  Case input_;
};

TEST_F(HostPacking, RestsAtItsPressureWithTheRecipesGrains) {
  const std::int64_t seed[] = {1};
  const PackedRve rve = make_packings(input_.soil, input_.packing, seed).front();
  EXPECT_EQ(rve.status, kernels::RveStatus::converged);
  EXPECT_NEAR(rve.pressure, 1.0e4, 2.0);  // 0.015 was measured
  EXPECT_LT(rve.unbalanced, 1e-5);        // 1.5e-7 was measured
  EXPECT_GT(rve.void_ratio, 0.15);
  EXPECT_LT(rve.void_ratio, 0.24);
  EXPECT_GT(rve.coordination, 3.3);  // isostatic without friction, less rattlers
  for (const double r : rve.packing.radii) {
    EXPECT_GE(r, 1.0e-3);
    EXPECT_LE(r, 2.375e-3);
  }
  EXPECT_NEAR(rve.packing.materials[0].friction, std::tan(input_.soil.friction), 1e-15) << "the working friction";
}

TEST_F(HostPacking, AWantedVoidRatioIsFoundThroughTheTemporaryFriction) {
  const std::int64_t seeds[] = {1};
  input_.packing.grains = 100;  // fewer jump too far from one friction to the next
  input_.packing.void_ratio = 0.25;
  for (const PackedRve& rve : make_packings(input_.soil, input_.packing, seeds)) {
    EXPECT_EQ(rve.status, kernels::RveStatus::converged);
    EXPECT_NEAR(rve.void_ratio, 0.25, 0.01);
    EXPECT_GT(rve.consolidation_friction, 0.01);
    EXPECT_NEAR(rve.packing.materials[0].friction, std::tan(input_.soil.friction), 1e-15);
  }
  input_.packing.grains = 40;
  input_.packing.void_ratio = 0.02;  // no packing is that dense
  EXPECT_NE(make_packings(input_.soil, input_.packing, seeds).front().status, kernels::RveStatus::converged);
}

TEST_F(HostPacking, ASeedsPackingDoesNotDependOnTheOthers) {
  const std::int64_t both[] = {1, 2}, alone[] = {2};
  const PackedRve beside = make_packings(input_.soil, input_.packing, both)[1];
  const PackedRve by_itself = make_packings(input_.soil, input_.packing, alone)[0];
  EXPECT_EQ(beside.position, by_itself.position);
  EXPECT_EQ(beside.contact_history, by_itself.contact_history);
}

TEST_F(HostPacking, IsMadeOnceAndReadBackBitForBit) {
  std::vector<std::string> notes;
  const PackingNote note = [&](const std::string& line) { notes.push_back(line); };
  const std::int64_t seed[] = {3};
  const PackedRve made = obtain_packings(input_.soil, input_.packing, seed, note).front();
  const PackedRve found = obtain_packings(input_.soil, input_.packing, seed, note).front();
  ASSERT_EQ(notes.size(), 2U);
  EXPECT_EQ(notes[0].rfind("packing made", 0), 0U);
  EXPECT_EQ(notes[1].rfind("packing found", 0), 0U);
  EXPECT_EQ(made.position, found.position);
  EXPECT_EQ(made.contact_key, found.contact_key);
  EXPECT_EQ(made.contact_history, found.contact_history);
}

TEST_F(HostPacking, ADamagedFileIsMadeAnew) {
  const std::int64_t seed[] = {3};
  const PackedRve made = obtain_packings(input_.soil, input_.packing, seed).front();
  for (const auto& file : std::filesystem::directory_iterator(folder_)) {
    std::filesystem::resize_file(file.path(), std::filesystem::file_size(file.path()) / 2);
  }
  EXPECT_EQ(obtain_packings(input_.soil, input_.packing, seed).front().position, made.position);
}

TEST_F(HostPacking, OfSeveralSeedsTheLeastBiasedIsChosen) {
  input_.packing.candidates = 3;
  const PackedRve chosen = choose_packing(input_.soil, input_.packing);
  const std::vector<PackedRve> all = obtain_packings(input_.soil, input_.packing, seeds_of(input_.packing));
  ASSERT_EQ(all.size(), 3U);
  for (const PackedRve& rve : all) EXPECT_LE(chosen.bias, rve.bias);
}

TEST_F(HostPacking, SoftGrainsCanStillBePacked) {
  input_.soil.modulus = 1.0e8;  // their oedometric test ends on its overlaps, which is no reason not to pack them
  input_.packing.candidates = 2;
  EXPECT_EQ(choose_packing(input_.soil, input_.packing).status, kernels::RveStatus::converged);
}

TEST_F(HostPacking, APoolsStateGoesThroughBytesBitForBit) {
  const std::int64_t seed[] = {1};
  const PackedRve rve = make_packings(input_.soil, input_.packing, seed).front();
  EngineCase engine;
  RvePool straight(rve, {engine}, 3), restarted(rve, {engine}, 3);
  const auto load = [](RvePool& pool, double strain) {
    fem::Gradient h = fem::Gradient::Zero();
    h(1, 1) = -strain;
    const std::vector<fem::Gradient> gradients(3, h);
    std::vector<fem::Stress> stress(3);
    std::vector<fem::Tangent> tangent(3);
    pool.begin_increment();
    EXPECT_TRUE(pool.evaluate(gradients, stress, tangent).usable);
    pool.commit();
    return stress[2];
  };
  load(straight, 1e-4);
  restarted.set_state(straight.state());
  EXPECT_EQ(load(straight, 2e-4), load(restarted, 2e-4));
  EXPECT_EQ(straight.state(), restarted.state());
  std::vector<std::byte> bytes = straight.state();
  bytes.pop_back();
  expect_throws<std::runtime_error>([&] { restarted.set_state(bytes); }, "not those of this case");
}

}  // namespace
}  // namespace voussoir::host
