/// From the text of a scene to SceneCase: what is read, what is refused with which sentence and place, and how regions
/// take soils and packings over.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "host/case/load_case.hpp"
#include "host/case/scene_names.hpp"
#include "io/input_error.hpp"

namespace voussoir::host {
namespace {

const std::string head = R"(kind = "scene"
)";
const std::string grid = R"([mesh]
shape = "grid"
x = ["0 m", "2 m", "3 m"]
columns = [2, 1]
y = ["0 m", "1 m"]
rows = 3
base = ["floor", "door"]
)";
const std::string region = R"([[region]]
name = "ground"
)";
const std::string support = R"([[support]]
boundary = ["floor", "door"]
fix = "xy"
)";
const std::string gravity = R"([[stage]]
name = "gravity"
gravity = 1
)";
const std::string lowering = R"([[stage]]
name = "lowering"
steps = 4
[[stage.move]]
boundary = "door"
y = "-1 cm"
)";

void write(const std::string& name, const std::string& text) {
  std::filesystem::remove(name);
  std::ofstream(name) << text;
}

Case read(const std::string& text, const std::vector<std::string>& overrides = {}) {
  write("scene.toml", text);
  return load_case("scene.toml", overrides);
}

/// What is said of the text, without the number of the line where `line` is not wanted.
std::string said_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    static_cast<void>(read(text, overrides));
  } catch (const io::InputError& error) {
    return error.what();
  }
  return "nothing";
}

std::string in_stage(const std::string& keys) {
  return head + grid + region + support + gravity + "[[stage]]\nname = \"second\"\n" + keys;
}

/// Expects that a text is refused with this sentence, and that the place is the last line that holds `at`.
void expect_said(const std::string& text, const std::string& at, const std::string& sentence) {
  const std::size_t place = text.rfind(at);
  ASSERT_NE(place, std::string::npos) << at;
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(place), '\n');
  EXPECT_EQ(said_of(text), fmt::format("scene.toml:{}: {}", line, sentence));
}

TEST(SceneCase, ReadsAWholeScene) {
  const Case input = read(head + grid + region + support + gravity + lowering + R"([[record]]
name = "surface"
line = [["0 m", "1 m"], "top_right"]
points = 7
)");
  const SceneCase& scene = input.scene;
  EXPECT_EQ(scene.mesh.x, (std::vector<double>{0, 2, 3}));
  EXPECT_EQ(scene.mesh.rows, (std::vector<std::int64_t>{3}));
  EXPECT_EQ(scene.mesh.x_ratio, (std::vector<double>{1, 1}));
  EXPECT_EQ(scene.mesh.base, (std::vector<std::string>{"floor", "door"}));
  EXPECT_EQ(scene.mesh.top, (std::vector<std::string>{"top", "top"}));
  EXPECT_EQ(scene.mesh.layers, std::vector<std::string>{"ground"});
  ASSERT_EQ(scene.regions.size(), 1U);
  EXPECT_EQ(scene.regions[0].unit_weight, 20e3);
  EXPECT_FALSE(scene.regions[0].elastic);
  EXPECT_EQ(scene.supports[0].boundaries.size(), 2U);
  EXPECT_TRUE(scene.supports[0].x && scene.supports[0].y);
  ASSERT_EQ(scene.stages.size(), 2U);
  EXPECT_EQ(scene.stages[0].steps, 0);
  EXPECT_EQ(scene.stages[0].geometry, LossGeometry::fixed_mesh);
  EXPECT_EQ(scene.stages[1].geometry, LossGeometry::updated_lagrangian);
  EXPECT_FALSE(scene.stages[1].gravity);
  EXPECT_FALSE(scene.stages[1].moves[0].x);
  EXPECT_DOUBLE_EQ(scene.stages[1].moves[0].y.value_or(0), -0.01);
  ASSERT_TRUE(scene.records[0].line);
  EXPECT_EQ((*scene.records[0].line)[0].at, (std::array<double, 2>{0, 1}));
  EXPECT_EQ((*scene.records[0].line)[1].name, "top_right");
  EXPECT_EQ(scene.records[0].points, 7);
}

TEST(SceneCase, AllCasesOfTheRepositoryRead) {
  int scenes = 0;
  for (const auto& folder : std::filesystem::directory_iterator(std::filesystem::path(VOUSSOIR_SOURCE_DIR) / "cases")) {
    const std::filesystem::path file = folder.path() / "case.toml";
    if (!std::filesystem::exists(file)) continue;
    SCOPED_TRACE(file.string());
    const Case input = load_case(file);
    if (input.kind != CaseKind::scene) continue;
    ++scenes;
    EXPECT_FALSE(input.scene.regions.empty());
    EXPECT_EQ(input.remarks, std::vector<std::string>{});
    // What a scene resolves to is a scene that says the same.
    write("resolved.toml", input.resolved);
    if (!input.scene.mesh.file.empty()) continue;  // its name is relative to the case's folder
    EXPECT_EQ(load_case("resolved.toml").fingerprint, input.fingerprint);
  }
  EXPECT_GE(scenes, 10);
}

TEST(SceneCase, OverridesReachIntoArraysOfTables) {
  const std::string text = head + grid + region + support + gravity + lowering;
  const Case input = read(text,
                          {"stage[1].move[0].y=-10 cm", "stage[1].move[0].x=0 m", "region[0].soil.modulus=1 GPa"});
  EXPECT_DOUBLE_EQ(input.scene.stages[1].moves[0].y.value_or(0), -0.1);
  EXPECT_DOUBLE_EQ(input.scene.stages[1].moves[0].x.value_or(1), 0.0);
  EXPECT_EQ(input.scene.regions[0].soil.modulus, 1e9);
  EXPECT_EQ(said_of(text, {"stage[1].move[1].y=-10 cm"}), "--set stage[1].move: has no entry [1]");
}

TEST(SceneCase, ARegionTakesOverFilesThenTheScene) {
  std::filesystem::create_directories("soils");
  write("soils/base.toml", "[soil]\nfriction = \"30 deg\"\n[packing]\ngrains = 500\n");
  write("soils/gravel.toml",
        "extends = \"base.toml\"\n[soil]\nmodulus = \"5 GPa\"\nsize_minimum = \"1 cm\"\nsize_maximum = \"2 "
        "cm\"\n[packing]\n"
        "void_ratio = 0.2\npressure = \"5 kPa\"\n");
  const std::string text = head + R"([soil]
sizes = ["2 mm", "4 mm"]
passing = [0, 1]
modulus = "3 GPa"
damping = 0.5
[packing]
grains = 300
consolidation_friction = 0.3
variety = 4
)" + grid + region + "unit_weight = \"0 N/m3\"\nextends = \"soils/gravel.toml\"\n[region.soil]\nmodulus = \"7 GPa\"\n" +
                           lowering;
  const Case input = read(text);
  const RegionCase& own = input.scene.regions[0];
  EXPECT_EQ(own.soil.modulus, 7e9);                    // the region's own
  EXPECT_NEAR(own.soil.friction_angle, 0.5236, 1e-4);  // of the file that its file extends
  EXPECT_EQ(own.soil.damping, 0.5);                    // of the scene
  EXPECT_TRUE(own.soil.sizes.empty());                 // another way to say the sizes, which the file says
  EXPECT_EQ(own.soil.size_maximum, 0.02);
  EXPECT_EQ(own.packing.grains, 500);
  EXPECT_EQ(own.packing.variety, 4);
  EXPECT_EQ(own.packing.void_ratio, 0.2);
  EXPECT_EQ(own.packing.consolidation_friction, 0.0);
  EXPECT_EQ(own.packing.pressure, 1e3);  // one for all regions
  EXPECT_EQ(input.soil.modulus, 3e9);
  for (const char* line : {"modulus = \"7 GPa\"\n", "friction = \"30 deg\"  # soils/base.toml:2\n",
                           "damping = 0.5  # [soil]\n", "variety = 4  # [packing]\n"})
    EXPECT_NE(input.resolved.find(line), std::string::npos) << line << input.resolved;
  write("soils/base.toml", "[soil]\nfriction = \"31 deg\"\n[packing]\ngrains = 500\n");
  EXPECT_NE(read(text).fingerprint, input.fingerprint);
  write("soils/base.toml", "\n[soil]\nfrictoin = \"31 deg\"\n");
  EXPECT_EQ(said_of(text), "soils/base.toml:3: region[0].soil.frictoin: unknown key; did you mean \"friction\"?");
  write("soils/base.toml", "[soil]\nfriction = \"90 deg\"\n");
  EXPECT_EQ(said_of(text), "soils/base.toml:2: region[0].soil.friction: must be at most 80 deg, is 90 deg");
}

TEST(SceneCase, RegionsAreElasticOrOfGrains) {
  const Case input = read(head + grid + region + "[region.elastic]\nmodulus = \"1 GPa\"\n" + support + gravity +
                          lowering);
  ASSERT_TRUE(input.scene.regions[0].elastic);
  EXPECT_EQ(input.scene.regions[0].elastic->modulus, 1e9);
  const std::string rest = support + gravity;
  expect_said(head + grid + region + "[region.elastic]\n[region.soil]\nmodulus = \"1 GPa\"\n" + rest, "[region.soil]",
              "region[0].soil: is given beside elastic: a region is elastic or of grains");
  expect_said(head + grid + region + "[region.packing]\npressure = \"2 kPa\"\n" + rest, "pressure",
              "region[0].packing.pressure: is one for all regions: give packing.pressure");
  expect_said(head + grid + region + "[region.packing]\nseed = 2\n" + rest, "seed",
              "region[0].packing.seed: is one for all regions: give packing.seed");
  expect_said(head + grid + region + "[region.packing]\nvariety = 16\ncandidates = 8\n" + rest, "variety",
              "region[0].packing.variety: asks for 16 different packings, but packing.candidates has only 8");
  expect_said(head + grid + region + "extends = \"none.toml\"\n" + rest, "extends",
              "region[0].extends: none.toml does not exist");
  write("empty.toml", "[ground]\n");
  expect_said(head + grid + region + "extends = \"empty.toml\"\n" + rest, "extends",
              "region[0].extends: names a file with neither [soil] nor [packing]");
}

TEST(SceneCase, NamesAreThoseOfTheMesh) {
  const std::string rest = gravity + lowering;
  expect_said(head + grid + region + "[[region]]\nname = \"bnk\"\n" + rest, "name = \"bnk\"",
              "region[1].name: the mesh has no region 'bnk'; it has ground");
  expect_said(head + grid + "layers = [\"bank\"]\n" + region + rest, "name = \"ground\"",
              "region[0].name: the mesh has no region 'ground'; it has bank");
  expect_said(head + grid + "regions = [[\"ground\", \"wall\"]]\n" + region + rest, "[mesh]",
              "mesh: region 'wall' of the mesh has no [[region]]");
  expect_said(
      head + grid + region + "[[support]]\nboundary = [\"door\", \"flor\"]\nfix = \"x\"\n" + rest, "boundary = [",
      "support[0].boundary: the mesh has no boundary 'flor'; it has floor, door, right, top, left; did you mean "
      "'floor'?");
  expect_said(head + grid + region + "[[support]]\npoint = \"corner\"\nfix = \"x\"\n" + rest, "point",
              "support[0].point: the mesh has no point 'corner'; it has base_left, base_right, top_left, top_right");
  expect_said(
      in_stage("steps = 1\n[[stage.press]]\nboundary = \"tpo\"\npressure = \"1 kPa\"\n"), "boundary",
      "stage[1].press[0].boundary: the mesh has no boundary 'tpo'; it has floor, door, right, top, left; did you "
      "mean 'top'?");
  expect_said(in_stage("steps = 1\n[[stage.release]]\nboundary = \"x\"\n"), "boundary",
              "stage[1].release[0].boundary: the mesh has no boundary 'x'; it has floor, door, right, top, left");
  expect_said(in_stage("steps = 1\n[[stage.excavate]]\nregion = \"core\"\n"),
              "region =", "stage[1].excavate[0].region: the mesh has no region 'core'; it has ground");
  expect_said(
      in_stage("steps = 1\n[[stage.move]]\nboundary = \"door\"\narea = -0.1\nabout = \"crown\"\n"), "about",
      "stage[1].move[0].about: the mesh has no point 'crown'; it has base_left, base_right, top_left, top_right");
  expect_said(
      in_stage("steps = 1\n[[stage.move]]\npoint = \"crown\"\nx = \"1 m\"\n"), "point",
      "stage[1].move[0].point: the mesh has no point 'crown'; it has base_left, base_right, top_left, top_right");
  for (const char* key : {"point", "region"}) {
    const std::string scene = fmt::format("{}{}{}{}[[record]]\nname = \"r\"\n{} = \"nowhere\"\n", head, grid, region,
                                          rest, key);
    EXPECT_NE(said_of(scene).find(fmt::format("record[0].{}: the mesh has no {} 'nowhere'; it has ", key, key)),
              std::string::npos);
  }
}

TEST(SceneCase, NamesOfAMeshFileAreCheckedWhenItIsKnown) {
  write("slope.msh", "$MeshFormat\n");
  const Case input = read(head + "[mesh]\nfile = \"slope.msh\"\nunit = \"1 cm\"\n" + region + support + gravity);
  EXPECT_EQ(input.scene.mesh.shape, MeshShape::file);
  EXPECT_EQ(input.scene.mesh.unit, 0.01);
  EXPECT_NO_THROW(check_scene_names(input, {{"floor", "door"}, {"ground"}, {}}));
  const auto said = [&](const MeshNames& names) {
    try {
      check_scene_names(input, names);
    } catch (const io::InputError& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  EXPECT_EQ(said({{"floor", "door"}, {"bank", "foundation"}, {}}),
            "scene.toml:6: region[0].name: the mesh has no region 'ground'; it has bank, foundation");
  EXPECT_EQ(said({{"floor"}, {"ground"}, {}}),
            "scene.toml:8: support[0].boundary: the mesh has no boundary 'door'; it has floor; did you mean 'floor'?");
  EXPECT_EQ(said({{"floor", "the door"}, {"ground"}, {}}),
            "scene.toml:3: mesh.file: the boundary 'the door' names columns of results: it must have 1 to 64 letters, "
            "digits, _ or -");
  write("slope.msh", "$MeshFormat\n4.1\n");
  EXPECT_NE(load_case("scene.toml").fingerprint, input.fingerprint);
}

TEST(SceneCase, StagesHaveTheStepsAndTheGeometryOfWhatTheyChange) {
  const std::string move = "[[stage.move]]\nboundary = \"door\"\ny = \"1 cm\"\n";
  expect_said(head + grid + region + support + gravity + "steps = 3\n", "steps",
              "stage[0].steps: is for stages that do more: [gravity] says the steps of this one");
  expect_said(in_stage(move), "[[stage]]", "stage[1].steps: is missing");
  expect_said(in_stage("tilt = \"20 deg\"\n"), "[[stage]]", "stage[1].steps: is missing");
  EXPECT_EQ(read(in_stage("tilt = \"20 deg\"\nsteps = 3\n")).scene.stages[1].geometry, LossGeometry::fixed_mesh);
  expect_said(in_stage("steps = 2\ngeometry = \"fixed_mesh\"\n" + move), "geometry",
              "stage[1].geometry: \"fixed_mesh\" is for stages in which only weights and tractions at rest change");
  expect_said(in_stage("steps = 2\n"), "[[stage]]",
              "stage[1]: changes nothing: it needs gravity, tilt, or a table move, press, release or excavate");
  expect_said(in_stage("steps = 2\ntilt = \"0 deg\"\n"), "[[stage]]",
              "stage[1]: changes nothing: it needs gravity, tilt, or a table move, press, release or excavate");
  expect_said(in_stage("gravity = 1\n"), "gravity", "stage[1].gravity: is 1 already before this stage");
  expect_said(head + grid + region + "unit_weight = \"0 N/m3\"\n" + gravity, "gravity = 1",
              "stage[0].gravity: is not 0, but no region has a unit_weight above 0");
  EXPECT_EQ(said_of(head + grid + region + support),
            "scene.toml:1: stage: is missing: a scene needs at least one [[stage]]");
  expect_said(head + grid + region + gravity + "[[stage]]\nname = \"gravity\"\nsteps = 1\ntilt = \"1 deg\"\n",
              "name = \"gravity\"", "stage[1].name: 'gravity' is the name of an earlier one, too");
  expect_said(head + grid + region + "[[stage]]\nname = \"a b\"\n", "name = \"a b\"",
              "stage[0].name: names columns of results: it must have 1 to 64 letters, digits, _ or -");
}

TEST(SceneCase, MovesHaveOneTargetAndOneMotion) {
  const auto move = [](const std::string& keys) { return in_stage("steps = 1\n[[stage.move]]\n" + keys); };
  expect_said(move("y = \"1 m\"\n"), "[[stage.move]]", "stage[1].move[0]: must have one of boundary and point");
  expect_said(move("boundary = \"door\"\npoint = \"top_left\"\ny = \"1 m\"\n"), "point",
              "stage[1].move[0].point: must have one of boundary and point");
  expect_said(move("boundary = \"door\"\n"), "[[stage.move]]",
              "stage[1].move[0]: moves nothing: it needs x, y, rotation or area");
  expect_said(move("boundary = \"door\"\narea = 0.1\nabout = [\"0 m\", \"0 m\"]\ny = \"1 m\"\n"),
              "y =", "stage[1].move[0].y: is given beside area, which holds both axes");
  expect_said(move("boundary = \"door\"\nrotation = \"1 deg\"\n"), "[[stage.move]]",
              "stage[1].move[0].about: is missing: it is the centre of rotation");
  expect_said(move("boundary = \"door\"\nx = \"1 m\"\nabout = \"top_left\"\n"), "about",
              "stage[1].move[0].about: is given without rotation or area, whose centre it is");
  expect_said(move("point = \"top_left\"\narea = 0.1\nabout = \"top_left\"\n"), "area",
              "stage[1].move[0].area: is for a boundary: a point moves by x and y");
  expect_said(move("point = [\"1 m\"]\nx = \"1 m\"\n"), "point",
              R"(stage[1].move[0].point: must be the name of a point or two lengths, such as ["1 m", "2 m"])");
  const MoveCase turned = read(move("boundary = \"door\"\nrotation = \"90 deg\"\nabout = [\"1 m\", \"2 m\"]\n"))
                              .scene.stages[1]
                              .moves[0];
  EXPECT_NEAR(turned.rotation.value_or(0), 1.5707963, 1e-6);
  EXPECT_EQ(turned.about.at, (std::array<double, 2>{1, 2}));
}

TEST(SceneCase, PressesHaveOneLoad) {
  const auto press = [](const std::string& keys) {
    return in_stage("steps = 1\n[[stage.press]]\nboundary = \"top\"\n" + keys);
  };
  expect_said(press(""), "[[stage.press]]",
              "stage[1].press[0]: must have one of pressure, traction and at_rest = true");
  expect_said(press("pressure = \"1 kPa\"\nat_rest = true\n"), "[[stage.press]]",
              "stage[1].press[0]: must have one of pressure, traction and at_rest = true");
  expect_said(press("traction = [\"1 kPa\"]\n"), "traction",
              "stage[1].press[0].traction: must have two entries, along x and along y");
  expect_said(press("pressure = \"1 kPa\"\n[[stage.press]]\nboundary = \"top\"\npressure = \"2 kPa\"\n"), "boundary",
              "stage[1].press[1].boundary: names 'top' for the second time in this stage");
  const PressCase sheared = read(press("traction = [\"1 kPa\", \"-2 kPa\"]\n")).scene.stages[1].presses[0];
  EXPECT_EQ(sheared.kind, PressKind::traction);
  EXPECT_EQ(sheared.traction, (std::array<double, 2>{1e3, -2e3}));
  expect_said(head + grid + region +
                  "[[stage]]\nname = \"a\"\nsteps = 1\n[[stage.press]]\nboundary = \"top\"\nat_rest = "
                  "true\n",
              "[[stage.press]]", "stage[0].press: has at_rest = true, but no weight acts in this stage: gravity is 0");
}

TEST(SceneCase, ARegionIsDugOutOnce) {
  const std::string dig = "steps = 1\n[[stage.excavate]]\nregion = \"ground\"\n";
  expect_said(in_stage(dig + "[[stage]]\nname = \"third\"\n" + dig), "region = \"ground\"",
              "stage[2].excavate[0].region: names 'ground', which stage 'second' has dug out");
}

TEST(SceneCase, SupportsAndRecordsHaveOneTarget) {
  const std::string rest = gravity;
  expect_said(head + grid + region + "[[support]]\nfix = \"x\"\n" + rest, "[[support]]",
              "support[0]: must have one of boundary and point");
  expect_said(head + grid + region + "[[support]]\nboundary = \"door\"\nfix = \"z\"\n" + rest, "fix",
              "support[0].fix: must be one of x, y, xy, is z");
  expect_said(head + grid + region + rest + "[[record]]\nname = \"a\"\n", "[[record]]",
              "record[0]: must have one of point, line and region");
  expect_said(head + grid + region + rest + "[[record]]\nname = \"a\"\npoint = \"top_left\"\npoints = 4\n", "points",
              "record[0].points: is given without line");
  expect_said(head + grid + region + rest + "[[record]]\nname = \"a\"\nline = [\"top_left\"]\n", "line",
              "record[0].line: must have 2 entries, has 1");
}

TEST(SceneCase, ShapesHaveKeysOfTheirOwn) {
  const std::string rest = region + support + gravity;
  const auto mesh = [&](const std::string& keys) { return head + "[mesh]\n" + keys + rest; };
  expect_said(mesh(""), "[mesh]", "mesh.shape: is missing: a mesh needs a shape or a file");
  expect_said(head + grid + "radius = \"1 m\"\n" + rest, "radius",
              "mesh.radius: is a key of the shape ring, and this mesh is a grid");
  expect_said(head + grid + "unit = \"1 m\"\n" + rest, "unit",
              "mesh.unit: is given without file, whose lengths it says");
  expect_said(mesh("shape = \"ring\"\nradius = \"1 m\"\nouter = \"2 m\"\ncolumns = [1, 2]\nrows = 3\n"), "columns",
              "mesh.columns: must be one number for a ring");
  expect_said(mesh("shape = \"grid\"\nx = [\"0 m\", \"1 m\", \"2 m\"]\ncolumns = 2\n"), "columns",
              "mesh.columns: must have one entry for each of the 2 intervals of x, has 1");
  expect_said(mesh("shape = \"grid\"\nx = [\"0 m\", \"1 m\", \"1 m\"]\n"), "x = [", "mesh.x: must ascend");
  expect_said(mesh("shape = \"grid\"\nx = [\"0 m\", \"1 m\"]\ncolumns = 20\nx_ratio = 10\n"), "x_ratio",
              "mesh.x_ratio: makes 20 elements whose lengths differ by more than a million");
  expect_said(head + grid + "top = [\"a\", \"b\", \"c\"]\n" + rest, "top",
              "mesh.top: must have one entry for each of the 2 intervals of x, has 3");
  expect_said(head + grid + "layers = [\"a\"]\nregions = [[\"a\", \"b\"]]\n" + rest, "layers",
              "mesh.layers: is given beside regions: one of the two names the regions");
  expect_said(head + grid + "regions = [[\"ground\"]]\n" + rest, "regions",
              "mesh.regions: must have a name for each of the 2 intervals of x in each list, has 1 in one");
  const std::string tunnel =
      "shape = \"tunnel\"\nwidth = \"70 m\"\nheight = \"35 m\"\ndiameter = \"5 m\"\ncover_ratio = 2\n"
      "size_opening = \"1 m\"\nsize_far = \"4 m\"\n";
  expect_said(mesh(tunnel + "interfaces = [\"10 m\"]\n"), "[mesh]",
              "mesh.layers: must have 2 entries, one more than interfaces, has 1; layers is not in the file, its "
              "default is [\"ground\"]");
  expect_said(mesh("shape = \"tunnel\"\nwidth = \"14 m\"\nheight = \"35 m\"\ndiameter = \"5 m\"\ncover_ratio = 2\n"
                   "size_opening = \"1 m\"\nsize_far = \"4 m\"\n"),
              "width", "mesh.width: is less than 3 tunnel diameters");
}

TEST(SceneCase, SaysWhichKeysDoNotCount) {
  const std::string
      text = head + "[soil]\ndensity = \"2000 kg/m3\"\n[column]\nelements = 9\n[gravity]\nratio = 2\n" + grid + region +
             "unit_weight = \"0 N/m3\"\n[region.packing]\nvoid_ratio = 0.2\nconsolidation_friction = 0.3\n" + lowering;
  const std::vector<std::string> remarks = read(text).remarks;
  const auto said = [&](const std::string& what) {
    return std::any_of(remarks.begin(), remarks.end(), [&](const std::string& line) { return line.starts_with(what); });
  };
  EXPECT_TRUE(said("column.elements (scene.toml:5): not used, because no stage has a press with at_rest"));
  EXPECT_TRUE(said("gravity.ratio (scene.toml:7): not used, because no stage puts gravity on alone"));
  EXPECT_TRUE(said("region[0].packing.consolidation_friction (scene.toml:"));
  EXPECT_TRUE(said("soil.density (scene.toml:3): not used, because the motion")) << "not of the region besides";
}

}  // namespace
}  // namespace voussoir::host
