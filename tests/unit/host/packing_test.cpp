// Packings: the recipe's targets, the same bits whoever is made beside them, the cache and its damage, and the numbers
// of the material that tell stored states apart.

#include "host/packing/packings.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "host/case/load_case.hpp"
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
  EXPECT_NEAR(rve.packing.materials[0].friction, std::tan(input_.soil.friction_angle), 1e-15) << "the working friction";
}

TEST_F(HostPacking, AWantedVoidRatioIsFoundThroughTheTemporaryFriction) {
  const std::int64_t seeds[] = {1};
  input_.packing.grains = 100;  // fewer jump too far from one friction to the next
  input_.packing.void_ratio = 0.25;
  for (const PackedRve& rve : make_packings(input_.soil, input_.packing, seeds)) {
    EXPECT_EQ(rve.status, kernels::RveStatus::converged);
    EXPECT_NEAR(rve.void_ratio, 0.25, 0.01);
    EXPECT_GT(rve.consolidation_friction, 0.01);
    EXPECT_NEAR(rve.packing.materials[0].friction, std::tan(input_.soil.friction_angle), 1e-15);
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
  const std::vector<fem::PointField> fields = straight.fields(), fields_again = restarted.fields();
  ASSERT_EQ(fields.size(), fields_again.size());
  for (std::size_t k = 0; k < fields.size(); ++k) {
    EXPECT_EQ(fields[k].values, fields_again[k].values) << fields[k].name << " is made of a number that is not stored";
  }
  EXPECT_EQ(load(straight, 2e-4), load(restarted, 2e-4));
  EXPECT_EQ(straight.state(), restarted.state());
  std::vector<std::byte> bytes = straight.state();
  bytes.pop_back();
  expect_throws<std::runtime_error>([&] { restarted.set_state(bytes); }, "not those of this case");
}

/// A case in which every number of the grains' material differs from its default, in [soil] and in a class.
Case case_of_other_grains() {
  const std::filesystem::path file = std::filesystem::temp_directory_path() /
                                     ("voussoir_other_grains_" + std::to_string(getpid()) + ".toml");
  std::ofstream(file) << R"(kind = "pack"
[soil]
modulus = "2 GPa"
stiffness_ratio = 0.4
friction = "20 deg"
rolling_stiffness = 0.9
rolling_limit = 0.5
[[soil.class]]
size_to = "3 mm"
modulus = "1 GPa"
stiffness_ratio = 0.3
friction = "15 deg"
rolling_stiffness = 0.8
rolling_limit = 0.4
[[soil.class]]
size_to = "4.75 mm"
)";
  Case input = load_case(file);
  std::filesystem::remove(file);
  return input;
}

/// A number that a new law brings along must be a key of the case file, in [soil] and in its classes.
TEST(GrainMaterialNumbers, ComeFromTheCaseFile) {
  const std::vector<kernels::GrainMaterial> materials = grain_materials(case_of_other_grains().soil);
  ASSERT_EQ(materials.size(), 2U);
  for (const auto& [name, number] : kernels::material_numbers) {
    const double usual = kernels::GrainMaterial{}.*number, of_class = materials[0].*number,
                 of_soil = materials[1].*number;
    EXPECT_NE(of_soil, usual) << name << " has no key in [soil]";
    EXPECT_NE(of_class, of_soil) << name << " has no key in [[soil.class]]";
    EXPECT_NE(of_class, usual) << name;
  }
}

/// Packings that are stored, and checkpoints, must not be taken for those of another material.
TEST(GrainMaterialNumbers, AreInRecipesAndIdentities) {
  Case input;
  EXPECT_EQ(recipe_text(input.soil, input.packing, 7),
            "recipe 2 d 0.002 0.00475 damping 0.3 t 0.1 grains 700 mu_t 0 p 1000 seed 7 E 3000000000 kt/kn 0.5 mu "
            "0.4663076581549986 beta 1 eta 0.6 by area");
  input.packing.grains = 60;
  input.packing.pressure = 1.0e4;
  const std::int64_t seed[] = {1};
  PackedRve rve = make_packings(input.soil, input.packing, seed).front();
  const std::uint64_t identity = RvePool(rve, {input.engine}, 1).identity();
  for (const auto& [name, number] : kernels::material_numbers) {
    double& value = rve.packing.materials[0].*number;
    const double before = value;
    value *= 0.99;
    EXPECT_NE(RvePool(rve, {input.engine}, 1).identity(), identity) << name;
    value = before;
  }
  EXPECT_EQ(RvePool(rve, {input.engine}, 1).identity(), identity);
}

}  // namespace
}  // namespace voussoir::host
