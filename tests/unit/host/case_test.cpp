// A case file becomes typed SI values, and everything wrong in it is refused.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "host/case/load_case.hpp"
#include "io/case_file.hpp"

namespace voussoir::host {
namespace {

std::filesystem::path write(const std::string& text) {
  const auto file = std::filesystem::path(testing::TempDir()) / "case_under_test.toml";
  std::ofstream(file) << text;
  return file;
}

std::string complaint(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    (void)load_case(write(text), overrides);
  } catch (const io::InputError& error) {
    return error.what();
  }
  return "";
}

/// A wrong case, and what its complaint must name.
struct Mistake {
  std::string text;
  std::vector<std::string> overrides;
  int line;  ///< of the case file; 0: the fault lies in an override
  std::string key;
  std::string part;  ///< of the sentence behind the key
};

void expect_refused(const Mistake& mistake) {
  const std::string said = complaint(mistake.text, mistake.overrides);
  const std::string file = (std::filesystem::path(testing::TempDir()) / "case_under_test.toml").string();
  const std::string place = mistake.line == 0 ? "--set " : file + ":" + std::to_string(mistake.line) + ": ";
  EXPECT_TRUE(said.starts_with(place + mistake.key + ": "))
      << "\"" << said << "\" does not name " << place << mistake.key;
  EXPECT_NE(said.find(mistake.part, place.size() + mistake.key.size()), std::string::npos)
      << "\"" << said << "\" does not say \"" << mistake.part << "\"";
}

TEST(Case, GradientsOfAPathKeepTheAreaAndHaveASizeToSearchIn) {
  const auto path = [](const std::string& keys) { return complaint("kind = 'probe'\n[[probe.path]]\n" + keys); };
  EXPECT_EQ(path("gradient = [0, 0, 0, -1e-3]\nconstant_xx = true\n"), "");
  EXPECT_EQ(path("gradient = [0, 0, 0, 0]\n"), "");
  const std::string before = "kind = 'probe'\n[[probe.path]]\n", key = "probe.path[0].gradient";
  expect_refused({before + "gradient = [0, 0, 0, 0]\nconstant_xx = true\n", {}, 3, key, "must not be 0"});
  expect_refused({before + "gradient = [1e-3, 0, 0, 0]\nconstant_xx = true\n", {}, 3, key, "must have no xx"});
  expect_refused({before + "gradient = [0, 0, 0]\n", {}, 3, key, "must have 4 entries, has 3"});
  expect_refused({before + "gradient = [-0.5, 0.5, 0.5, -0.5]\n", {}, 3, key, "leaves no area"});
}

TEST(Case, DefaultsAreThoseOfTheDeclarations) {
  const Case input = load_case(write("kind = 'tunnel'\n"));
  const Case declared;
  EXPECT_EQ(input.kind, CaseKind::tunnel);
  EXPECT_EQ(input.material, MaterialKind::grains);
  EXPECT_EQ(input.soil.size_minimum, declared.soil.size_minimum);
  EXPECT_NEAR(input.soil.friction_angle, 25 * std::numbers::pi / 180, 1e-15);
  EXPECT_EQ(input.packing.grains, declared.packing.grains);
  EXPECT_EQ(input.engine.inertial_number, declared.engine.inertial_number);
  EXPECT_EQ(input.volume_loss.total, declared.volume_loss.total);
  EXPECT_EQ(input.newton.smallest_cut, declared.newton.smallest_cut);
}

TEST(Case, AGpuAdvancesTheRvesOfAMeshAndFindsNoLoadingTangents) {
  const std::string gpu = "kind = 'tunnel'\n[engine]\nbackend = 'gpu'\n";
  EXPECT_EQ(load_case(write(gpu)).engine.backend, Backend::gpu);
  for (const char* tangent : {"contact", "elastic", "static"}) {
    EXPECT_EQ(complaint(gpu, {std::string("newton.tangent=") + tangent}), "");
  }
  expect_refused({gpu, {"newton.tangent=loading"}, 0, "newton.tangent", "is not computed by engine.backend = \"gpu\""});
  EXPECT_EQ(load_case(write("kind = 'tunnel'\n")).engine.backend, Backend::automatic);
  for (const char* kind : {"probe", "biaxial"}) {
    const std::string head = std::string("kind = '") + kind + "'\n[engine]\n";
    expect_refused({head + "backend = 'gpu'\n", {}, 3, "engine.backend", "is for kinds with a mesh only"});
    EXPECT_EQ(load_case(write(head + "backend = 'auto'\n")).engine.backend, Backend::lanes);
  }
}

TEST(Case, RvesAreDeferredOnAMeshOnly) {
  for (const char* kind : {"tunnel", "column", "biaxial_bvp"}) {
    EXPECT_EQ(load_case(write(std::string("kind = '") + kind + "'\n"), {"engine.defer=1e-3"}).engine.defer, 1e-3);
  }
  for (const char* kind : {"probe", "pack", "biaxial"}) {
    const std::string text = std::string("kind = '") + kind + "'\n";
    expect_refused({text, {"engine.defer=1e-3"}, 0, "engine.defer", "is for kinds with a mesh"});
    EXPECT_EQ(complaint(text, {"engine.defer=0"}), "") << kind;
  }
}

TEST(Case, UnitsBecomeSi) {
  const Case input = load_case(
      write("kind = 'tunnel'\n[ground]\nunit_weight = '18 kN/m3'\n[volume_loss]\ntotal = '10 %'\n"),
      {"soil.friction=30 deg", "engine.precision=double"});
  EXPECT_DOUBLE_EQ(input.ground.unit_weight, 18e3);
  EXPECT_DOUBLE_EQ(input.volume_loss.total, 0.1);
  EXPECT_NEAR(input.soil.friction_angle, std::numbers::pi / 6, 1e-15);
  EXPECT_EQ(input.engine.precision, kernels::Precision::float64);
}

TEST(Case, HeightsFollowFromCoverAndDiameter) {
  const Case input = load_case(write("kind = 'tunnel'\n"), {"ground.cover_ratio=3"});
  EXPECT_DOUBLE_EQ(input.ground.crown_height(), 20);
  EXPECT_DOUBLE_EQ(input.ground.axis_height(), 17.5);
  EXPECT_DOUBLE_EQ(input.ground.invert_height(), 15);
}

TEST(Case, FingerprintFollowsWhatDecidesTheNumbers) {
  const std::string base = load_case(write("kind = 'tunnel'\n")).fingerprint;
  EXPECT_EQ(base, load_case(write("kind = 'tunnel'\n[output]\nevery = 5\n")).fingerprint);
  EXPECT_EQ(base, load_case(write("title = 'x'\nkind = 'tunnel'\n[ground]\ndiameter = '5 m'\n")).fingerprint);
  EXPECT_EQ(base,
            load_case(write("kind = 'tunnel'\n"), {"ground.diameter=500 cm", "volume_loss.total=0.2"}).fingerprint);
  EXPECT_NE(base, load_case(write("kind = 'tunnel'\n"), {"soil.friction=26 deg"}).fingerprint);
  EXPECT_NE(base, load_case(write("kind = 'tunnel'\n"), {"newton.tolerance=2e-3"}).fingerprint);
}

TEST(Case, ResolvedCaseGivesTheSameCase) {
  const Case input = load_case(write("kind = 'tunnel'\n"), {"ground.cover_ratio=3", "soil.friction=31 deg"});
  const Case again = load_case(write(input.resolved));
  EXPECT_EQ(input.soil.friction_angle, again.soil.friction_angle);
  EXPECT_EQ(input.ground.cover_ratio, again.ground.cover_ratio);
  EXPECT_EQ(input.engine.inertial_number, again.engine.inertial_number);
  EXPECT_EQ(input.packing.pressure, again.packing.pressure);
  const Case accurate = load_case(write("kind = 'tunnel'\n"), {"engine.accuracy=1 %"});
  EXPECT_EQ(load_case(write(accurate.resolved)).engine.accuracy, 0.01);
}

TEST(Case, AnUnknownKeyIsReportedBeforeWhatItMakesWrong) {
  const std::string sizes = "kind = 'pack'\n[soil]\nsizes = ['1 mm', '2 mm']\n";
  expect_refused({sizes + "pasing = [0, 1]\n", {}, 4, "soil.pasing", "unknown key; did you mean \"passing\"?"});
  expect_refused({sizes, {"soil.pasing=[0, 1]"}, 0, "soil.pasing", "unknown key; did you mean \"passing\"?"});
  expect_refused({sizes, {}, 2, "soil.passing", "must have as many entries as sizes, has 0 in place of 2"});
  expect_refused({"kidn = 'tunnel'\n", {}, 1, "kidn", "unknown key; did you mean \"kind\"?"});
  expect_refused({"kind = 'tunel'\nweather = 3\n", {}, 2, "weather", "unknown key"});
  expect_refused({"kind = 'tunel'\n[biaxial]\nstrain = 3\n", {}, 1, "kind", "must be one of pack, "});
  expect_refused({"kind = 'probe'\n[[probe.path]]\ngradeint = [0, 0, 0, 0]\n",
                  {},
                  3,
                  "probe.path[0].gradeint",
                  "did you mean \"gradient\"?"});
}

TEST(Case, WrongValuesAreRefusedAtTheirPlace) {
  const std::string tunnel = "kind = 'tunnel'\n";
  expect_refused({"kind = 'tunel'\n", {}, 1, "kind", "must be one of pack, "});
  expect_refused({"[soil]\n", {}, 1, "kind", "is missing"});
  expect_refused({"kind = 'pack'\n[ground]\ndiameter = '5 m'\n", {}, 2, "ground", "unknown key"});
  expect_refused({"kind = 'column'\n", {"volume_loss.total=1 %"}, 0, "volume_loss", "unknown key"});
  expect_refused({tunnel + "[soil]\nsize_maximum = '1 mm'\n", {}, 3, "soil.size_maximum", "smaller than size_minimum"});
  expect_refused({tunnel, {"soil.size_maximum=1 mm"}, 0, "soil.size_maximum", "smaller than size_minimum"});
  expect_refused({tunnel, {"soil.damping=1.5"}, 0, "soil.damping", "must be at most 0.9, is 1.5"});
  expect_refused({tunnel, {"engine.maximum_steps=10"}, 0, "engine.maximum_steps", "smaller than minimum_steps"});
  expect_refused({tunnel, {"ground.cover_ratio=10"}, 0, "ground.cover_ratio", "below the invert"});
  expect_refused({tunnel, {"ground.width=6 m"}, 0, "ground.width", "less than 1.5 tunnel diameters"});
  expect_refused({tunnel, {"ground.mesh_size_far=10 cm"}, 0, "ground.mesh_size_far", "smaller than mesh_size_opening"});
  expect_refused({tunnel, {"newton.tolerance=0"}, 0, "newton.tolerance", "must be at least 1e-15, is 0"});
  expect_refused({tunnel + "[packing]\npressure = '2 kPa'\n[ground]\nsurcharge = '1 kPa'\n",
                  {},
                  5,
                  "ground.surcharge",
                  "must equal packing.pressure"});
  expect_refused({"title = 'a/b'\n" + tunnel, {}, 1, "title", "no / in it"});
  EXPECT_EQ(complaint("kind = 'column'\n"), "");
}

}  // namespace
}  // namespace voussoir::host
