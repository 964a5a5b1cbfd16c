// The estimate of a scene: lanes that hold an RVE, and the recipes of its regions.
#include "host/estimate/scene.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "host/ensemble/draws.hpp"
#include "host/estimate/range.hpp"
#include "host/estimate/report.hpp"
#include "host/packing/case_recipes.hpp"

namespace voussoir::host {
namespace {

RegionSize region_of(std::size_t points, int variety) {
  return {.name = "ground", .points = points, .variety = variety, .grains = 300};
}

TEST(ShareOfLanes, OnePackingFillsGroupsAndManyDoNot) {
  EXPECT_DOUBLE_EQ(share_of_lanes({region_of(1792, 1)}, 16), 1.0);
  EXPECT_DOUBLE_EQ(share_of_lanes({region_of(1792, 16)}, 16), 1.0);
  EXPECT_DOUBLE_EQ(share_of_lanes({region_of(648, 16)}, 16), 648.0 / (16 * 48));  // 40 or 41 points each
  EXPECT_DOUBLE_EQ(share_of_lanes({region_of(100, 100)}, 16), 1.0 / 16);
  EXPECT_DOUBLE_EQ(share_of_lanes({region_of(100, 100)}, 1), 1.0);
  EXPECT_DOUBLE_EQ(share_of_lanes({region_of(16, 1), region_of(8, 1), region_of(40, 0)}, 16), 24.0 / 32);
  EXPECT_DOUBLE_EQ(share_of_lanes({region_of(40, 0)}, 16), 1.0) << "an elastic region has no RVE";
}

TEST(ShareOfLanes, BelowFourFifthsItIsTold) {
  EXPECT_TRUE(lanes_warning({.lanes_share = 0.8}).empty());
  EXPECT_NE(lanes_warning({.lanes_share = 0.5}).find("50 % full"), std::string::npos);
}

/// A wall of two soils with an elastic region between them.
Case wall() {
  Case input;
  input.kind = CaseKind::scene;
  input.scene.regions.resize(3);
  const char* names[] = {"fill", "wall", "bank"};
  for (std::size_t k = 0; k < 3; ++k) input.scene.regions[k].names = {names[k]};
  input.scene.regions[1].elastic = ElasticCase{};
  return input;
}

TEST(Seeds, OfMembersAreNoSeedsOfAnother) {
  Case input = wall();
  input.packing.seed = 7;
  input.packing.candidates = 2;
  for (RegionCase& region : input.scene.regions) region.packing = input.packing;
  input.scene.regions[2].packing.candidates = 5;  // more than the scene draws elsewhere
  EXPECT_EQ(seed_of(input, 0), 7);
  EXPECT_EQ(seed_of(input, 1), 12);
  EXPECT_EQ(seed_of(input, 3), 22);
}

TEST(Recipes, AreThoseOfTheRegionsWithGrains) {
  Case input = wall();
  const std::vector<SoilRecipe> recipes = recipes_of(input);
  ASSERT_EQ(recipes.size(), 2U);
  EXPECT_EQ(recipes[1].soil, &input.scene.regions[2].soil);
  EXPECT_EQ(recipes[1].table, "region[2].");
  EXPECT_TRUE(has_grains(input));
  for (RegionCase& region : input.scene.regions) region.elastic = ElasticCase{};
  EXPECT_FALSE(has_grains(input));
  input = wall();
  input.material = MaterialKind::linear_elastic;
  EXPECT_FALSE(has_grains(input));
  input.kind = CaseKind::biaxial;  // it has no mesh, on which the material counts
  EXPECT_TRUE(has_grains(input));
  input.kind = CaseKind::tunnel;
  EXPECT_FALSE(has_grains(input));
}

TEST(Foretold, ASceneIsPressedByItsWeightAndByItsBoundaries) {
  Case input = wall();
  input.packing.pressure = 2e3;
  input.scene.regions[2].unit_weight = 25e3;
  EXPECT_NE(foretell(input, 4.0).line.find("mean stress 77 kPa"), std::string::npos) << foretell(input, 4.0).line;
  input.scene.stages.resize(1);
  input.scene.stages[0].presses = {{.boundary = "top", .kind = PressKind::pressure, .pressure = 1e8}};
  const Foretold pressed = foretell(input, 4.0);
  ASSERT_FALSE(pressed.warnings.empty());
  EXPECT_EQ(pressed.warnings[0].rfind("region fill: ", 0), 0U) << pressed.warnings[0];
}

}  // namespace
}  // namespace voussoir::host
