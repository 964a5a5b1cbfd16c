// A stored packing says which soil it was made with, in its labels, its recipe or, of Yade, its numbers.
#include "host/case/made_with.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "host/packing/recipe.hpp"

namespace voussoir::host {
namespace {

/// A gravel of two classes with a grading curve.
SoilCase gravel() {
  SoilCase soil;
  soil.sizes = {2e-3, 1e-2, 4e-2};
  soil.passing = {0, 0.3, 1};
  soil.damping = 0.25;
  soil.thickness = 0.05;
  soil.classes = {{1e-2, 3e9, 0.5, 0.4, 0.03, 0.6}, {4e-2, 5e9, 0.8, 0.7, 0.04, 0.8}};
  return soil;
}

io::Packing labelled(const std::string& name, const std::string& text) {
  io::Packing file;
  file.labels[name] = text;
  return file;
}

TEST(MadeWith, ARecipeTellsItsSoil) {
  for (const SoilCase& soil : {SoilCase{}, gravel()}) {
    const io::Packing file = labelled("recipe", recipe_text(soil, {}, 7));
    EXPECT_FALSE(soil_keys_of(file).empty());
    EXPECT_TRUE(differences(soil_keys(soil), soil_keys_of(file)).empty());
  }
  EXPECT_TRUE(soil_keys_of(labelled("recipe", "path of first")).empty());
  EXPECT_TRUE(soil_keys_of(labelled("recipe", "recipe 2 d x")).empty());
}

TEST(MadeWith, EveryNumberOfASoilThatDiffersIsNamed) {
  const SoilCase made = gravel();
  const io::Packing file = labelled("recipe", recipe_text(made, {}, 7));
  const auto differs = [&](const char* key, auto change) {
    SoilCase soil = made;
    change(soil);
    const auto found = differences(soil_keys(soil), soil_keys_of(file));
    ASSERT_EQ(found.size(), 1U) << key;
    EXPECT_EQ(found.front().key, key);
    EXPECT_NE(found.front().ours, found.front().theirs);
  };
  differs("soil.thickness", [](SoilCase& s) { s.thickness = 0.1; });
  differs("soil.damping", [](SoilCase& s) { s.damping = 0.3; });
  differs("soil.sizes", [](SoilCase& s) { s.sizes[1] = 2e-2; });
  differs("soil.passing", [](SoilCase& s) { s.passing[1] = 0.4; });
  differs("soil.passing_by", [](SoilCase& s) { s.passing_by = GradingMeasure::number; });
  differs("soil.class[0].size_to", [](SoilCase& s) { s.classes[0].size_to = 2e-2; });
  differs("soil.class[0].modulus", [](SoilCase& s) { s.classes[0].modulus = 2e9; });
  differs("soil.class[0].stiffness_ratio", [](SoilCase& s) { s.classes[0].stiffness_ratio = 0.6; });
  differs("soil.class[1].friction", [](SoilCase& s) { s.classes[1].friction_angle = 0.6; });
  differs("soil.class[1].rolling_stiffness", [](SoilCase& s) { s.classes[1].rolling_stiffness = 0; });
  differs("soil.class[1].rolling_limit", [](SoilCase& s) { s.classes[1].rolling_limit = 0; });
  SoilCase soil = made;
  soil.density = 2000;  // no number depends on it
  EXPECT_TRUE(differences(soil_keys(soil), soil_keys_of(file)).empty());
}

TEST(MadeWith, YadesNumbersAreComparedAsFarAsTheyGo) {
  io::Packing file;
  file.numbers = {{"E", 3e9}, {"phi_deg", 25.0}, {"etaRoll", 0.6}, {"N", 700}};
  EXPECT_EQ(soil_keys_of(file).size(), 3U);
  EXPECT_TRUE(differences(soil_keys(SoilCase{}), soil_keys_of(file)).empty());
  SoilCase softer;
  softer.modulus = 3e8;
  const auto found = differences(soil_keys(softer), soil_keys_of(file));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found.front().key + " " + found.front().ours + " " + found.front().theirs, "soil.modulus 300 MPa 3 GPa");
}

}  // namespace
}  // namespace voussoir::host
