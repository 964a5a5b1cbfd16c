// Gradings by number and by area, classes of grains, and their mistakes in a case file.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>

#include "host/case/load_case.hpp"
#include "host/packing/grading.hpp"
#include "host/packing/recipe.hpp"
#include "io/case_file.hpp"

namespace voussoir::host {
namespace {

/// Share of the grains' area in grains of at most `size`.
double area_below(const std::vector<double>& radii, double size) {
  double below = 0, all = 0;
  for (const double r : radii) {
    all += r * r;
    if (2.0 * r <= size) below += r * r;
  }
  return below / all;
}

SoilCase fuller() {
  SoilCase soil;
  soil.sizes = {2e-3, 4.75e-3, 10e-3, 19e-3, 28e-3, 40e-3};
  for (const double d : soil.sizes) {
    soil.passing.push_back((std::sqrt(d) - std::sqrt(2e-3)) / (std::sqrt(40e-3) - std::sqrt(2e-3)));
  }
  return soil;
}

TEST(Grading, UniformByNumberUnlessACurveIsGiven) {
  const std::vector<double> radii = sample_radii(SoilCase{}, 1000, 1);
  const double mean = std::accumulate(radii.begin(), radii.end(), 0.0) / 1000.0;
  EXPECT_NEAR(mean, 0.5 * (1.0e-3 + 2.375e-3), 1e-6);  // stratified: better than chance
  EXPECT_TRUE(std::is_sorted(radii.rbegin(), radii.rend()));
  EXPECT_NE(radii, sample_radii(SoilCase{}, 1000, 2));
}

TEST(Grading, ByAreaFollowsFullersCurve) {
  const SoilCase soil = fuller();
  const std::vector<double> radii = sample_radii(soil, 1500, 1);
  for (std::size_t k = 1; k + 1 < soil.sizes.size(); ++k) {
    EXPECT_NEAR(area_below(radii, soil.sizes[k]), soil.passing[k], 0.015) << soil.sizes[k];
  }
  const auto coarse = std::count_if(radii.begin(), radii.end(), [](double r) { return 2 * r > 19e-3; });
  EXPECT_NEAR(static_cast<double>(coarse), 35, 5);  // Fuller's curve has so many of 1500 grains above 19 mm
}

TEST(Grading, ByNumberCountsGrains) {
  SoilCase soil = fuller();
  soil.sizes = {2e-3, 4e-3, 8e-3};
  soil.passing = {0, 0.75, 1};
  soil.passing_by = GradingMeasure::number;
  const std::vector<double> radii = sample_radii(soil, 400, 3);
  EXPECT_EQ(std::count_if(radii.begin(), radii.end(), [](double r) { return 2 * r <= 4e-3; }), 300);
}

TEST(Grading, GrainsHaveTheMaterialOfTheirClass) {
  SoilCase soil = fuller();
  soil.classes = {{4.75e-3, 3e9, 0.5, 0.43, 1, 0.6}, {19e-3, 4e9, 0.7, 0.70, 1, 0.7}, {40e-3, 5e9, 0.8, 0.87, 1, 0.8}};
  const kernels::Packing packing = packing_of(soil, {20e-3, 9.6e-3, 9.4e-3, 2.4e-3, 1e-3}, 0.1);
  const double expected[] = {5e9, 5e9, 4e9, 4e9, 3e9};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(packing.material_of(i).modulus, expected[i]) << i;
  EXPECT_NEAR(packing.material_of(2).friction, std::tan(0.70), 1e-15);
}

TEST(Grading, RecipesOfDifferentSoilsDiffer) {
  const PackingCase recipe;
  SoilCase changed = fuller();
  changed.passing[2] += 0.01;
  EXPECT_NE(recipe_text(fuller(), recipe, 1), recipe_text(changed, recipe, 1));
  changed = fuller();
  changed.passing_by = GradingMeasure::number;
  EXPECT_NE(recipe_text(fuller(), recipe, 1), recipe_text(changed, recipe, 1));
}

/// What a case of this [soil] is told, without the name of its file: "LINE: KEY: SENTENCE", or nothing.
std::string complaint(const std::string& soil) {
  const auto file = std::filesystem::temp_directory_path() / ("voussoir_grading_" + std::to_string(getpid()) + ".toml");
  std::ofstream(file) << "kind = \"pack\"\n[soil]\n" << soil << "\n";
  std::string message;
  try {
    static_cast<void>(load_case(file));
  } catch (const io::InputError& error) {
    message = error.what();
  }
  std::filesystem::remove(file);
  return message.starts_with(file.string() + ":") ? message.substr(file.string().size() + 1) : message;
}

TEST(Grading, MistakesAreNamed) {
  const auto expect = [](const std::string& soil, const std::string& place, const std::string& part) {
    const std::string said = complaint(soil);
    EXPECT_TRUE(said.starts_with(place + ": ")) << said;
    EXPECT_NE(said.find(part), std::string::npos) << said;
  };
  const std::string two = "sizes = [\"2 mm\", \"4 mm\"]\n", three = "sizes = [\"2 mm\", \"4 mm\", \"5 mm\"]\n";
  expect(two + "passing = [0, 0.9]", "4: soil.passing", "must rise from 0 to 1, but entry 2 (0.9) is the last one");
  expect(two + "passing = [\"6 %\", 1]", "4: soil.passing",
         "must rise from 0 to 1, but entry 1 (6 %) is the first one");
  expect("sizes = [\"2 mm\"]\npassing = [1]", "4: soil.passing", "has only one entry");
  expect("sizes = [\"4 mm\", \"2 mm\"]\npassing = [0, 1]", "3: soil.sizes",
         "entry 2 (2 mm) is not larger than entry 1");
  expect(three + "passing = [0, \"38 %\",\n\"30 %\"]", "5: soil.passing",
         "must not fall, but entry 3 (30 %) is smaller than entry 2 (38 %)");
  expect(two + "passing = [0, 0.5, 1]", "4: soil.passing", "must have as many entries as sizes, has 3 in place of 2");
  expect("passing = [0, 1]", "2: soil.sizes", "must have as many entries as passing, has 0 in place of 2");
  expect("[[soil.class]]\nsize_to = \"3 mm\"", "3: soil.class",
         "the last one ends at 3 mm, and the largest grain has 4.75");
  expect("[[soil.class]]\nsize_to = \"3 mm\"\n[[soil.class]]\nsize_to = \"2 mm\"", "6: soil.class[1].size_to",
         "must ascend, but 2 mm is not larger than 3 mm");
  EXPECT_EQ(complaint("[[soil.class]]\nsize_to = \"3 mm\"\n[[soil.class]]\nsize_to = \"5 mm\"\nfriction = \"40 deg\""),
            "");
}

TEST(Grading, SizesThatDifferTooMuchAreNamedByTheKeysThatTheUserWrote) {
  EXPECT_EQ(complaint("sizes = [\"1 mm\", \"2 mm\",\n\"20 cm\"]\npassing = [0, 0.4, 1]"),
            "4: soil.sizes: entry 3 (20 cm) is more than 40 times entry 1 (1 mm): an RVE cannot hold grains of so "
            "different sizes");
  EXPECT_TRUE(complaint("size_maximum = \"20 cm\"").starts_with("3: soil.size_maximum: size_maximum (20 cm) is more"));
  EXPECT_TRUE(complaint("size_minimum = \"1 um\"").starts_with("3: soil.size_minimum: size_maximum (4.75 mm) is more"));
  EXPECT_EQ(complaint("sizes = [\"1 mm\", \"40 mm\"]\npassing = [0, 1]"), "");
}

}  // namespace
}  // namespace voussoir::host
