// Several names in one key of a scene: what is read and computed of them, and which lists are refused.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "host/case/load_case.hpp"
#include "host/scene/describe_scene.hpp"
#include "host/scene/scene_of.hpp"
#include "io/input_error.hpp"

namespace voussoir::host {
namespace {

using Names = std::vector<std::string>;

/// Three layers of 1 m, the regions a, b and c, and the tables that a test adds.
std::string scene(const std::string& regions, const std::string& more = "") {
  return R"(kind = "scene"
material = "linear_elastic"
[mesh]
shape = "grid"
x = ["0 m", "2 m"]
columns = 2
y = ["0 m", "1 m", "2 m", "3 m"]
rows = [1, 1, 1]
layers = ["a", "b", "c"]
)" + regions +
         R"(
[[support]]
boundary = ["base", "left"]
fix = "xy"
[[stage]]
name = "gravity"
gravity = 1
)" + more;
}

const std::string two_tables = R"([[region]]
name = ["c", "b"]
unit_weight = "18 kN/m3"
[[region]]
name = "a"
)";

Case read(const std::string& text) { return case_of_text(text, "scene"); }

std::string said_of(const std::string& text) {
  try {
    static_cast<void>(planned_scene(read(text)));
  } catch (const io::InputError& error) {
    const std::string what = error.what();
    return what.substr(what.find(": ") + 2);  // without the place
  }
  return "nothing";
}

TEST(Lists, GiveSeveralRegionsOneWeight) {
  const Case input = read(scene(two_tables));
  ASSERT_EQ(input.scene.regions.size(), 2U);
  EXPECT_EQ(input.scene.regions[0].names, (Names{"c", "b"}));
  EXPECT_EQ(input.scene.regions[1].names, Names{"a"});
  EXPECT_EQ(read(input.resolved).fingerprint, input.fingerprint);
  const PlannedScene planned = planned_scene(input);
  for (int e = 0; e < 6; ++e) EXPECT_EQ(planned.scene.unit_weight(e), e < 2 ? 20e3 : 18e3) << e;
  const Names lines = describe(input, planned);
  for (const char* name : {"a", "b", "c"})
    EXPECT_TRUE(std::any_of(lines.begin(), lines.end(), [&](const auto& line) {
      return line.starts_with(fmt::format("region {}: linear elastic, 50 MPa; ", name));
    })) << name;
}

TEST(Lists, DigOutAndRecordSeveralRegions) {
  const PlannedScene planned = planned_scene(read(scene(two_tables, R"([[stage]]
name = "dig"
steps = 1
[[stage.excavate]]
region = ["b", "c"]
[[record]]
name = "top"
region = ["a", "c"]
)")));
  EXPECT_EQ(planned.plans[1].dug_out, (std::vector<char>{0, 0, 1, 1, 1, 1}));
  EXPECT_EQ(planned.records[0].elements, (std::vector<int>{0, 1, 4, 5}));
  EXPECT_EQ(column_names(planned.records).front(), "p_top");
}

TEST(Lists, NameEachRegionOnce) {
  const auto regions = [](const char* names) { return scene(fmt::format("[[region]]\nname = {}\n", names)); };
  EXPECT_EQ(said_of(regions("[\"a\", \"b\", \"c\"]")), "nothing");
  EXPECT_EQ(said_of(regions("[\"a\", \"b\", \"a\"]")), "region[0].name: names \"a\" twice");
  EXPECT_EQ(said_of(regions("[]")), "region[0].name: must have at least 1 entry, has 0");
  EXPECT_EQ(said_of(regions("[\"a\", \"rock\"]")), "region[0].name: the mesh has no region 'rock'; it has a, b, c");
  EXPECT_EQ(said_of(regions("[\"a\", \"b\"]")), "mesh: region 'c' of the mesh has no [[region]]");
  EXPECT_EQ(said_of(scene(two_tables + "[[region]]\nname = [\"d\", \"b\"]\n")),
            "region[2].name: 'b' is the name of an earlier one, too");
}

TEST(Lists, NameOnceWhatIsDugOutRecordedAndHeld) {
  const std::string dig = "[[stage]]\nname = \"dig\"\nsteps = 1\n[[stage.excavate]]\nregion = ";
  EXPECT_EQ(said_of(scene(two_tables, dig + "[\"b\", \"b\"]\n")), "stage[1].excavate[0].region: names \"b\" twice");
  EXPECT_EQ(said_of(scene(two_tables, dig + "[\"b\", \"c\"]\n[[stage.excavate]]\nregion = \"c\"\n")),
            "stage[1].excavate[1].region: names 'c' for the second time in this stage");
  EXPECT_EQ(said_of(scene(two_tables, dig + "[\"b\", \"c\"]\n[[stage]]\nname = \"on\"\nsteps = 1\n[[stage.excavate]]\n"
                                            "region = [\"a\", \"b\"]\n")),
            "stage[2].excavate[0].region: names 'b', which stage 'dig' has dug out");
  EXPECT_EQ(said_of(scene(two_tables, "[[record]]\nname = \"r\"\nregion = [\"a\", \"a\"]\n")),
            "record[0].region: names \"a\" twice");
  EXPECT_EQ(said_of(scene(two_tables + "[[support]]\nboundary = [\"right\", \"right\"]\nfix = \"x\"\n")),
            "support[0].boundary: names \"right\" twice");
}

/// The lines of `check` about stages.
Names stages_of(const std::string& text) {
  const Case input = read(text);
  Names lines = describe(input, planned_scene(input));
  std::erase_if(lines, [](const std::string& line) { return !line.starts_with("stage "); });
  return lines;
}

/// Points without a name are called by their place, and are held no longer where they have been dug out.
TEST(Points, AreNamedByTheirPlaceWhileTheyAreThere) {
  const std::string dig = R"([[stage]]
name = "dig"
steps = 1
[[stage.excavate]]
region = "c"
)";
  const std::string held = two_tables + "[[support]]\npoint = [\"2 m\", \"3 m\"]\nfix = \"y\"\n";
  const Names stages = stages_of(scene(held, dig));
  ASSERT_EQ(stages.size(), 2U);
  EXPECT_NE(stages[0].find("the point (2, 3) m y"), std::string::npos) << stages[0];
  EXPECT_EQ(stages[1].find("the point"), std::string::npos) << stages[1];
  EXPECT_EQ(said_of(scene(two_tables, R"([[stage]]
name = "pull"
steps = 1
[[stage.move]]
point = ["2 m", "3 m"]
x = "1 m"
)")),
            "stage[1].steps: the point (2, 3) m moves by 1 of an element's edge a step: more steps");
}

/// `check` does not speak of a share where no force fades, and says whom the nodes of a point belong to.
TEST(Releases, SayWhoOwnsTheNodes) {
  const auto words = [](const std::string& fix, const std::string& releases, const std::string& more = "") {
    const std::string
        support = "[[support]]\nboundary = \"right\"\nfix = \"x\"\n[[support]]\npoint = \"top_right\"\nfix = ";
    const std::string line = stages_of(scene(two_tables, support + "\"" + fix + "\"\n[[stage]]\nname = \"off\"\n" +
                                                             "steps = 1\nrelease = [" + releases + "]\n" + more))
                                 .at(1);
    const std::size_t first = line.find("; ", line.find("held: "));
    return line.substr(first + 2);
  };
  const std::string point = "{point = \"top_right\", share = 0.1}";
  EXPECT_EQ(words("x", point), "top_right is released, right owns x of its node");
  EXPECT_EQ(words("xy", point), "top_right is released by 10 %, right owns x of its node");
  EXPECT_EQ(words("y", point), "top_right is released by 10 %");
  EXPECT_EQ(words("x", point + ", {boundary = \"right\"}"),
            "top_right is released by 10 %; right is released by 100 %");
  EXPECT_EQ(words("y", "{boundary = \"right\"}", "move = [{boundary = \"right\", x = \"0 m\"}]\n"),
            "right is released, a motion holds x of its nodes");
}

TEST(Releases, HaveOneTarget) {
  const auto release = [](const char* keys) {
    return said_of(
        scene(two_tables, fmt::format("[[stage]]\nname = \"off\"\nsteps = 1\n[[stage.release]]\n{}\n", keys)));
  };
  EXPECT_EQ(release("share = 1"), "stage[1].release[0]: must have one of boundary and point");
  EXPECT_EQ(release("boundary = \"left\"\npoint = \"top_left\""),
            "stage[1].release[0].point: must have one of boundary and point");
  EXPECT_EQ(release("point = \"crown\""),
            "stage[1].release[0].point: the mesh has no point 'crown'; it has base_left, base_right, top_left, "
            "top_right");
  EXPECT_EQ(release("point = \"top_left\""), "stage[1].release[0].point: nothing holds top_left as a point");
  EXPECT_EQ(release("boundary = \"left\""), "nothing");
}

}  // namespace
}  // namespace voussoir::host
