/// Sweep files: axes crossed and advancing together, names of runs and folders, seeds of members, and what is refused.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "host/case/load_case.hpp"
#include "host/sweep/axes.hpp"
#include "host/sweep/sweep_file.hpp"
#include "io/input_error.hpp"

namespace voussoir::host {
namespace {

namespace fs = std::filesystem;

/// A folder with a small tunnel of grains and a sweep file, removed at the end.
class SweepFileTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / ("sweep_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
    for (const char* name : {"tunnel.toml", "other.toml"})
      write(name, "kind = \"tunnel\"\n[ground]\ncover_ratio = 2\n[packing]\ncandidates = 3\nseed = 11\n");
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }

  SweepPlan plan(const std::string& text) const {
    write("sweep.toml", text);
    return load_sweep(folder_ / "sweep.toml");
  }

  /// The message with which a sweep is refused.
  std::string fault(const std::string& text) const {
    try {
      static_cast<void>(plan(text));
    } catch (const io::InputError& error) {
      return error.what();
    }
    return "";
  }

  fs::path folder_;
};

std::vector<std::string> names_of(const SweepPlan& plan) {
  std::vector<std::string> names;
  for (const PlannedRun& run : plan.runs) names.push_back(run.name);
  return names;
}

using Names = std::vector<std::string>;

TEST(AxesTest, ValuesBecomeNamesOfFolders) {
  EXPECT_EQ(name_of_value("2.5"), "2.5");
  EXPECT_EQ(name_of_value("\"5 mm\""), "5mm");
  EXPECT_EQ(name_of_value("\"20 kN/m3\""), "20kN_m3");
  EXPECT_EQ(name_of_value("\"20 %\""), "20pct");
  EXPECT_EQ(name_of_value("[1, 2]"), "1_2");
}

TEST(AxesTest, TheLastAxisChangesFastest) {
  const std::vector<GridPoint> points = cross({{axis_of_key("a.x", {"1", "2"})}, {axis_of_key("a.y", {"3", "4"})}});
  ASSERT_EQ(points.size(), 4U);
  EXPECT_EQ(points[1].name, "x_1-y_4");
  EXPECT_EQ(points[1].overrides, (Names{"a.x=1", "a.y=4"}));
  EXPECT_EQ(points[2].values.front(), (std::pair<std::string, std::string>{"x", "2"}));
}

TEST_F(SweepFileTest, CrossedAxesAndNamedSoils) {
  const SweepPlan found = plan(R"(base = "tunnel.toml"
set = ["engine.preset=fast"]
[grid]
"ground.cover_ratio" = [1, 1.5]
[grid.soil]
dense = "packing.consolidation_friction=0"
loose = ["packing.consolidation_friction=0.3", "ground.unit_weight=18 kN/m3"]
gravel = "other.toml"
)");
  EXPECT_EQ(names_of(found), (Names{"cover_ratio_1-dense", "cover_ratio_1-loose", "cover_ratio_1-gravel",
                                    "cover_ratio_1.5-dense", "cover_ratio_1.5-loose", "cover_ratio_1.5-gravel"}));
  EXPECT_EQ(found.runs[1].overrides, (Names{"engine.preset=fast", "ground.cover_ratio=1",
                                            "packing.consolidation_friction=0.3", "ground.unit_weight=18 kN/m3"}));
  EXPECT_EQ(found.runs[2].case_file.filename(), "other.toml");
  EXPECT_EQ(found.runs[3].case_file.filename(), "tunnel.toml");
  EXPECT_EQ(found.runs[1].axes.back(), (std::pair<std::string, std::string>{"soil", "loose"}));
}

TEST_F(SweepFileTest, AxesThatAdvanceTogether) {
  const SweepPlan found = plan(R"(base = "tunnel.toml"
[grid]
"ground.cover_ratio" = [1, 2]
"packing.grains" = [100, 200]
"ground.height" = ["30 m", "40 m"]
zip = [["ground.cover_ratio", "ground.height"]]
)");
  EXPECT_EQ(names_of(found), (Names{"cover_ratio_1-height_30m-grains_100", "cover_ratio_1-height_30m-grains_200",
                                    "cover_ratio_2-height_40m-grains_100", "cover_ratio_2-height_40m-grains_200"}));
}

TEST_F(SweepFileTest, AnAxisReachesIntoTablesOfStages) {
  write("scene.toml",
        "kind = \"scene\"\n[mesh]\nshape = \"grid\"\nx = [\"0 m\", \"1 m\"]\ny = [\"0 m\", \"1 m\"]\ncolumns = 1\nrows "
        "= 1\n"
        "[[region]]\nname = \"ground\"\n[[stage]]\nname = \"a\"\ngravity = 1\n[[stage]]\nname = \"b\"\nsteps = 2\n"
        "[[stage.move]]\nboundary = \"top\"\ny = \"-1 cm\"\n");
  const SweepPlan found = plan("base = \"scene.toml\"\n[grid]\n\"stage[1].move[0].y\" = [\"-5 cm\", \"3 cm\"]\n");
  EXPECT_EQ(names_of(found), (Names{"y_-5cm", "y_3cm"}));
  const Case second = load_case(found.runs[1].case_file, found.runs[1].overrides);
  EXPECT_EQ(second.scene.stages.at(1).moves.at(0).y.value_or(0), 0.03);
}

TEST_F(SweepFileTest, MembersDrawSeedsThatNoOtherMemberDraws) {
  const SweepPlan found = plan(R"(base = "tunnel.toml"
[[grid]]
name = "tunnels"
members = 2
"ground.cover_ratio" = [1, 2]
)");
  EXPECT_EQ(names_of(found), (Names{"tunnels/cover_ratio_1/member_000", "tunnels/cover_ratio_1/member_001",
                                    "tunnels/cover_ratio_2/member_000", "tunnels/cover_ratio_2/member_001"}));
  EXPECT_EQ(found.runs[0].overrides.back(), "packing.seed=11");
  EXPECT_EQ(found.runs[1].overrides.back(), "packing.seed=14");  // three candidates each
  ASSERT_EQ(found.ensembles.size(), 2U);
  EXPECT_EQ(found.ensembles[1].name, "tunnels/cover_ratio_2");
  EXPECT_EQ(found.ensembles[1].runs, (std::vector<std::size_t>{2, 3}));
  EXPECT_EQ(outcome_path("out", found.runs[3].name), "out/outcomes/tunnels__cover_ratio_2__member_001.json");
}

TEST_F(SweepFileTest, ListsAndGridsStandBesideOneAnother) {
  const SweepPlan found = plan(R"([[run]]
name = "alone"
base = "other.toml"
[[grid]]
base = "tunnel.toml"
"ground.cover_ratio" = 1
)");
  EXPECT_EQ(names_of(found), (Names{"alone", "cover_ratio_1"}));
}

TEST_F(SweepFileTest, FaultsAreSaidWithTheirPlace) {
  const std::string base = "base = \"tunnel.toml\"\n";
  const auto expect_fault = [this](const std::string& text, const Names& parts) {
    const std::string said = fault(text);
    for (const std::string& part : parts) EXPECT_NE(said.find(part), std::string::npos) << part << " in: " << said;
  };
  expect_fault(base, {"no [[run]] and no [grid]"});
  expect_fault(base + "[grid]\n\"a.b\" = []\n", {"sweep.toml:3", "has no values"});
  expect_fault(base + "[grid]\n\"a.b\" = [1, 1]\n", {"b_1 is the name of two runs"});
  expect_fault(base + "[grid]\n\"a.b\" = [1]\n\"c.b\" = [2]\n", {"sweep.toml:4", "second axis called b"});
  expect_fault(base + "[grid]\n\"a.b\" = [1, 2]\n\"c.d\" = [3]\nzip = [[\"a.b\", \"c.d\"]]\n",
               {"sweep.toml:5", "b has 2 values, and d has 1"});
  expect_fault(base + "[grid]\n\"a.b\" = [1]\nzip = [[\"a.b\", \"x\"]]\n", {"names x, which is no axis"});
  expect_fault(base + "[grid]\n\"a.b\" = [1]\nzip = [\"a.b\"]\n", {"array of arrays"});
  expect_fault(base + "[grid]\n\"a.b\" = [1]\nzip = []\n", {"array of arrays"});
  expect_fault(base + "[grid.soil]\ndense = \"oops\"\n", {"sweep.toml:3", "neither table.key=value nor"});
  expect_fault(base + "[grid.soil]\n\"a b\" = \"x.y=1\"\n", {"must consist of letters"});
  expect_fault("[grid]\n\"a.b\" = [1]\n", {"base", "is missing"});
  expect_fault(base + "[grid]\nmembers = 2\n\"ground.diametre\" = [1]\n", {"members", "diametre_1"});
  expect_fault(base + "[[run]]\nname = \"outcomes\"\n", {"that the sweep itself writes"});
  expect_fault(base + "[[run]]\nname = \"t\"\n[[grid]]\nname = \"t\"\n\"a.b\" = [1]\n",
               {"lies in the folder of the run t"});
  expect_fault(base + "[[run]]\nname = \"t__p\"\n[[grid]]\nname = \"t\"\n[grid.s]\np = \"a.b=1\"\n",
               {"t/p is the name of two runs", "t__p"});
}

TEST_F(SweepFileTest, AxesThatTheTablesCouldNotHoldAreRefused) {
  const std::string base = "base = \"tunnel.toml\"\n";
  const std::string ratio = "\"ground.cover_ratio\" = [1, 2]\n";
  for (const char* name : {"a/b", "a,b", ".", "", "status", "wall_s", "a b"}) {
    const std::string said = fault(base + "[grid.\"" + name + "\"]\nx = \"a.b=1\"\n");
    EXPECT_NE(said.find("sweep.toml:2"), std::string::npos) << name << ": " << said;
  }
  EXPECT_NE(fault(base + "[grid]\nmembers = 2\n[grid.member]\nx = \"a.b=1\"\n").find("column"), std::string::npos);
  EXPECT_EQ(fault(base + "[grid.member]\nx = \"a.b=1\"\n"), "");
  EXPECT_NE(fault(base + "[grid]\nground.cover_ratio = [1, 2]\n").find("in quotes"), std::string::npos);
  EXPECT_NE(fault(base + "[grid]\nmembers = 2\n").find("has no axis"), std::string::npos);
  EXPECT_NE(fault(base + "[grid]\n" + ratio + "zip = [[\"members\"]]\n").find("no axis"), std::string::npos);
}

TEST_F(SweepFileTest, AxesThatContradictOneAnotherAreRefused) {
  const std::string base = "base = \"tunnel.toml\"\n";
  const std::string three = "\"a.x\" = [1, 2]\n\"a.y\" = [1, 2]\n\"a.z\" = [1, 2]\n";
  EXPECT_NE(fault(base + "[grid]\n" + three + "zip = [[\"a.x\", \"a.y\"], [\"a.y\", \"a.z\"]]\n").find("a.y twice"),
            std::string::npos);
  EXPECT_NE(fault("[grid.a]\nx = \"tunnel.toml\"\n[grid.b]\ny = \"other.toml\"\n").find("names cases, and so does"),
            std::string::npos);
}

TEST_F(SweepFileTest, TooManyPointsAndTooLongNamesAreRefused) {
  const std::string base = "base = \"tunnel.toml\"\n";
  std::string axes;
  for (int axis = 0; axis < 30; ++axis)
    axes += "\"a.x" + std::to_string(axis) + "\" = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9]\n";
  EXPECT_NE(fault(base + "[grid]\n" + axes).find("more than 100000 points"), std::string::npos);
  const std::string half(150, 'n');
  EXPECT_NE(fault(base + "[[grid]]\nname = \"" + half + "\"\n[grid.s]\n" + half + " = \"a.b=1\"\n").find("too long"),
            std::string::npos);
}

TEST_F(SweepFileTest, ARunIsFoundByItsName) {
  const SweepPlan found = plan("base = \"tunnel.toml\"\n[grid]\n\"ground.cover_ratio\" = [1, 2]\n");
  EXPECT_EQ(&run_named(found, "cover_ratio_2"), &found.runs[1]);
  EXPECT_THROW(static_cast<void>(run_named(found, "cover_ratio_3")), io::InputError);
}

}  // namespace
}  // namespace voussoir::host
