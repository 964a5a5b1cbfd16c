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

TEST(Case, GradientsOfAPathKeepTheAreaAndHaveASizeToSearchIn) {
  const auto path = [](const std::string& keys) { return complaint("kind = 'probe'\n[[probe.path]]\n" + keys); };
  EXPECT_EQ(path("gradient = [0, 0, 0, -1e-3]\nconstant_xx = true\n"), "");
  EXPECT_EQ(path("gradient = [0, 0, 0, 0]\n"), "");
  EXPECT_NE(path("gradient = [0, 0, 0, 0]\nconstant_xx = true\n").find("must not be 0"), std::string::npos);
  EXPECT_NE(path("gradient = [-0.5, 0.5, 0.5, -0.5]\n").find("leaves no area"), std::string::npos);
}

TEST(Case, DefaultsAreThoseOfTheDeclarations) {
  const Case input = load_case(write("kind = 'tunnel'\n"));
  const Case declared;
  EXPECT_EQ(input.kind, CaseKind::tunnel);
  EXPECT_EQ(input.material, MaterialKind::grains);
  EXPECT_EQ(input.soil.size_minimum, declared.soil.size_minimum);
  EXPECT_NEAR(input.soil.friction, 25 * std::numbers::pi / 180, 1e-15);
  EXPECT_EQ(input.packing.grains, declared.packing.grains);
  EXPECT_EQ(input.engine.inertial_number, declared.engine.inertial_number);
  EXPECT_EQ(input.volume_loss.total, declared.volume_loss.total);
  EXPECT_EQ(input.newton.smallest_cut, declared.newton.smallest_cut);
}

TEST(Case, TeamsHaveNoStaticTangentAndRecordNoMicrostructure) {
  const std::string teams = "kind = 'tunnel'\n[engine]\nbackend = 'teams'\n";
  EXPECT_EQ(load_case(write(teams)).engine.backend, kernels::Backend::teams);
  EXPECT_FALSE(load_case(write(teams)).newton.tangent.has_value());  // eq. (4) there
  EXPECT_EQ(complaint(teams, {"newton.tangent=contact"}), "");
  EXPECT_NE(complaint(teams, {"newton.tangent=elastic"}).find("newton.tangent"), std::string::npos);
  EXPECT_NE(complaint(teams, {"newton.tangent=static"}).find("newton.tangent"), std::string::npos);
  EXPECT_NE(complaint("kind = 'probe'\n[engine]\nbackend = 'teams'\n", {"probe.tangent=loading"}).find("probe.tangent"),
            std::string::npos);
  const std::string biaxial = "kind = 'biaxial'\n[engine]\nbackend = 'teams'\n[output]\nmicrostructure = ['fabric']\n";
  EXPECT_NE(complaint(biaxial, {}).find("output.microstructure"), std::string::npos);
  EXPECT_EQ(load_case(write(biaxial), {"output.microstructure=[]"}).engine.backend, kernels::Backend::teams);
}

TEST(Case, RvesAreDeferredOnAMeshOnly) {
  for (const char* kind : {"tunnel", "column", "biaxial_bvp"}) {
    EXPECT_EQ(load_case(write(std::string("kind = '") + kind + "'\n"), {"engine.defer=1e-3"}).engine.defer, 1e-3);
  }
  for (const char* kind : {"probe", "pack", "biaxial"}) {
    const std::string text = std::string("kind = '") + kind + "'\n";
    EXPECT_NE(complaint(text, {"engine.defer=1e-3"}).find("engine.defer"), std::string::npos) << kind;
    EXPECT_EQ(complaint(text, {"engine.defer=0"}), complaint(text)) << kind;
  }
}

TEST(Case, UnitsBecomeSi) {
  const Case input = load_case(
      write("kind = 'tunnel'\n[ground]\nunit_weight = '18 kN/m3'\n[volume_loss]\ntotal = '10 %'\n"),
      {"soil.friction=30 deg", "engine.precision=double"});
  EXPECT_DOUBLE_EQ(input.ground.unit_weight, 18e3);
  EXPECT_DOUBLE_EQ(input.volume_loss.total, 0.1);
  EXPECT_NEAR(input.soil.friction, std::numbers::pi / 6, 1e-15);
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
  EXPECT_EQ(input.soil.friction, again.soil.friction);
  EXPECT_EQ(input.ground.cover_ratio, again.ground.cover_ratio);
  EXPECT_EQ(input.engine.inertial_number, again.engine.inertial_number);
  EXPECT_EQ(input.packing.pressure, again.packing.pressure);
}

TEST(Case, WrongValuesAreRefused) {
  EXPECT_NE(complaint("kind = 'tunel'\n"), "");
  EXPECT_NE(complaint("[soil]\n"), "");                                     // no kind
  EXPECT_NE(complaint("kind = 'pack'\n[ground]\ndiameter = '5 m'\n"), "");  // no table of this kind
  EXPECT_NE(complaint("kind = 'tunnel'\n", {"soil.size_maximum=1 mm"}), "");
  EXPECT_NE(complaint("kind = 'tunnel'\n", {"soil.damping=1.5"}), "");
  EXPECT_NE(complaint("kind = 'tunnel'\n", {"engine.maximum_steps=10"}), "");
  EXPECT_NE(complaint("kind = 'tunnel'\n", {"ground.cover_ratio=10"}), "");
  EXPECT_NE(complaint("kind = 'tunnel'\n", {"ground.width=6 m"}), "");
  EXPECT_NE(complaint("kind = 'tunnel'\n", {"ground.mesh_size_far=10 cm"}), "");
  EXPECT_NE(complaint("kind = 'tunnel'\n", {"packing.pressure=2 kPa"}), "");
  EXPECT_NE(complaint("kind = 'tunnel'\n", {"newton.tolerance=0"}), "");
  EXPECT_NE(complaint("kind = 'column'\n", {"volume_loss.total=1 %"}), "");
  EXPECT_EQ(complaint("kind = 'column'\n"), "");
}

}  // namespace
}  // namespace voussoir::host
