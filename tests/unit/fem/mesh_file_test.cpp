#include "fem/mesh_file.hpp"

#include <gtest/gtest.h>
#include <omp.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "fem/mesh_grid.hpp"
#include "tests/mesh_checks.hpp"
#include "tests/throws.hpp"

namespace voussoir::fem {
namespace {

using mesh_checks::length;
using mesh_checks::pieces;
using mesh_checks::region_area;

std::filesystem::path mesh_path(const std::string& name) {
  return std::filesystem::path(VOUSSOIR_SOURCE_DIR) / "tests/meshes" / name;
}

MeshFile read(const std::string& name) { return read_mesh_file(mesh_path(name), 1); }

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// A folder of a test's own, which goes with it.
class MeshFileTest : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& text, const std::string& name = "own.msh") {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  /// The mesh of a file's text.
  MeshFile read_text(const std::string& text) { return read_mesh_file(write(text), 1); }

  void expect_refused(const std::string& text, const std::string& sentence) {
    expect_throws<std::runtime_error>([&] { static_cast<void>(read_text(text)); }, sentence);
  }

  std::filesystem::path folder_ = std::filesystem::temp_directory_path() /
                                  ("voussoir_mesh_file_" + std::to_string(getpid()));
};

/// A file of version 2.2: lines of nodes ("1 0 0 0") and elements ("1 3 2 REGION SURFACE 1 2 3 4").
std::string file_22(const std::string& nodes, const std::string& elements) {
  const auto section = [](const std::string& name, const std::string& lines) {
    return "$" + name + "\n" + std::to_string(std::count(lines.begin(), lines.end(), '\n')) + "\n" + lines + "$End" +
           name + "\n";
  };
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" +
         section("PhysicalNames", "1 5 \"base\"\n1 6 \"middle\"\n2 7 \"soil\"\n2 8 \"rock\"\n0 9 \"mark\"\n") +
         section("Nodes", nodes) + section("Elements", elements);
}

/// Corners of two unit squares side by side, and the squares.
const std::string two_squares = "1 0 0 0\n2 1 0 0\n3 2 0 0\n4 0 1 0\n5 1 1 0\n6 2 1 0\n";
const std::string two_quads = "1 3 2 7 1 1 2 5 4\n2 3 2 8 2 2 3 6 5\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("the file has no " + from);
  return text.replace(at, from.size(), to);
}

TEST(MeshFile, TheTrapdoorIsTheSameInAllFormats) {
  const MeshFile file = read("trapdoor_q8.msh");
  const Mesh& mesh = file.mesh;
  mesh_checks::expect_sound(mesh);
  EXPECT_EQ(mesh.n_elements(), 84);
  EXPECT_EQ(mesh.n_nodes(), 293);
  EXPECT_NEAR(mesh_checks::area(mesh), 72, 1e-11);
  EXPECT_EQ(pieces(mesh, "base"), 2);
  EXPECT_NEAR(length(mesh, "base"), 10, 1e-11);
  EXPECT_NEAR(length(mesh, "door"), 2, 1e-11);
  EXPECT_NEAR(length(mesh, "top"), 12, 1e-11);
  EXPECT_NEAR(length(mesh, "left"), 6, 1e-11);
  EXPECT_EQ(mesh.edges.size(), 5u);
  EXPECT_EQ(mesh.region_names, std::vector<std::string>{"fill"});
  EXPECT_EQ(mesh.coordinates.col(mesh.point("door_corners_1")), Point(-1, 0));
  EXPECT_EQ(mesh.coordinates.col(mesh.point("door_corners_2")), Point(1, 0));
  ASSERT_EQ(file.remarks.size(), 1u);
  EXPECT_EQ(file.remarks[0],
            "the physical point door_corners has 2 points: door_corners_1 at (-1, 0), door_corners_2 at (1, 0)");
  for (const char* name : {"trapdoor_q8_v22.msh", "trapdoor_q8_bin.msh"}) {
    const Mesh other = read(name).mesh;
    // A text file has 16 digits.
    EXPECT_LT((other.coordinates - mesh.coordinates).cwiseAbs().maxCoeff(), 1e-14) << name;
    EXPECT_EQ(other.elements, mesh.elements) << name;
    EXPECT_EQ(other.edges, mesh.edges) << name;
    EXPECT_EQ(other.nodes, mesh.nodes) << name;
    EXPECT_EQ(other.points, mesh.points) << name;
    EXPECT_EQ(other.region, mesh.region) << name;
  }
}

TEST(MeshFile, StraightMidsidesLieAtTheCentre) {
  const Mesh mesh = read("trapdoor_q8.msh").mesh;
  for (const ElementNodes& e : mesh.elements)
    for (int k = 0; k < 4; ++k) {
      const Point centre = 0.5 * (mesh.coordinates.col(e[k]) + mesh.coordinates.col(e[(k + 1) % 4]));
      EXPECT_EQ(mesh.coordinates.col(e[4 + k]), centre);
    }
}

TEST(MeshFile, FourNodeElementsAreCompleted) {
  const MeshFile file = read("slope_quad4.msh");
  mesh_checks::expect_sound(file.mesh);
  EXPECT_EQ(file.mesh.n_elements(), 170);
  EXPECT_EQ(file.mesh.edges.size(), 6u);
  EXPECT_EQ(file.mesh.region_names, (std::vector<std::string>{"foundation", "bank"}));
  EXPECT_NEAR(region_area(file.mesh, "foundation"), 150, 1e-9);
  EXPECT_NEAR(region_area(file.mesh, "bank"), 75, 1e-9);
  EXPECT_NEAR(length(file.mesh, "face"), std::hypot(10, 5), 1e-9);
  EXPECT_EQ(file.remarks, std::vector<std::string>{"170 elements of 4 nodes completed to 8 nodes with straight edges"});
}

TEST(MeshFile, ClockwiseElementsAreTurnedRound) {
  const MeshFile file = read("clockwise_q8.msh");
  mesh_checks::expect_sound(file.mesh);
  EXPECT_EQ(file.mesh.n_elements(), 84);
  ASSERT_FALSE(file.remarks.empty());
  EXPECT_EQ(file.remarks[0], "24 elements were clockwise and turned round (the first: element 73)");
}

TEST(MeshFile, GroupsWithoutNamesHaveTheirTags) {
  const Mesh mesh = read("unnamed_groups.msh").mesh;
  mesh_checks::expect_sound(mesh);
  EXPECT_EQ(mesh.region_names, std::vector<std::string>{"7"});
  for (const char* name : {"11", "12", "13", "14"}) EXPECT_NEAR(length(mesh, name), 2, 1e-12);
}

TEST(MeshFile, BadMeshesAreRefusedWithWhatToDo) {
  const auto refused = [](const char* name, const std::string& sentence) {
    expect_throws<std::runtime_error>([&] { static_cast<void>(read(name)); }, sentence);
  };
  refused("bad_text.msh", "bad_text.msh is no Gmsh mesh: its first line is not $MeshFormat");
  refused("bad_truncated.msh", "bad_truncated.msh cannot be read: Could not read nodes");
  refused("bad_mixed.msh",
          "99 triangles (the first in region bank): only quadrilaterals of 4 or 8 nodes; in Gmsh: Mesh.RecombineAll = "
          "1, Mesh.RecombinationAlgorithm = 2");
  refused("bad_plane_xz.msh", "node 3 has z = 2: the mesh must lie in the plane x-y");
  refused("bad_no_groups.msh", "no physical surface: regions are named by physical surfaces");
  refused("bad_lost_surface.msh",
          "20 edges of the boundaries left, face, crest belong to no element: Gmsh leaves out surfaces that are in no "
          "physical surface");
  refused("bad_unglued.msh",
          "3 nodes lie on top of others (first at (1, 0)): the surfaces are not glued; in Gmsh: Coherence");
  refused("trapdoor_q8.geo", "trapdoor_q8.geo is no Gmsh mesh: its name does not end in .msh");
  refused("none.msh", "none.msh cannot be read: there is no such file");
}

TEST_F(MeshFileTest, AScriptIsNotRun) {
  const std::filesystem::path mark = folder_ / "it_ran";
  const std::string script = "SystemCall \"touch " + mark.string() + "\";\n";
  expect_refused(script, "own.msh is no Gmsh mesh: its first line is not $MeshFormat");
  expect_refused("\n" + text_of(mesh_path("trapdoor_q8.msh")) + script, "its first line is not $MeshFormat");
  expect_refused("$MeshFormatted\n" + script, "its first line is not $MeshFormat");
  write(script, "own.msh.opt");  // Gmsh runs it with the mesh
  expect_refused(text_of(mesh_path("trapdoor_q8.msh")),
                 "own.msh.opt lies beside the mesh, and Gmsh would run it as a script; move it away");
  EXPECT_FALSE(std::filesystem::exists(mark));
}

TEST_F(MeshFileTest, FilesOfOtherSystemsAreRead) {
  std::string text;
  for (const char letter : text_of(mesh_path("trapdoor_q8.msh")))
    text += letter == '\n' ? std::string("\r\n") : std::string(1, letter);
  EXPECT_EQ(read_text(text).mesh.coordinates, read("trapdoor_q8.msh").mesh.coordinates);
}

TEST_F(MeshFileTest, LengthsHaveTheUnitOfTheFile) {
  const Mesh mesh = read_mesh_file(mesh_path("trapdoor_q8.msh"), 1e-3).mesh;
  EXPECT_NEAR(mesh_checks::area(mesh), 72e-6, 1e-16);
}

TEST(MeshFile, TheThreadNumberIsLeftAlone) {
  omp_set_num_threads(3);
  static_cast<void>(read("trapdoor_q8.msh"));
  EXPECT_EQ(omp_get_max_threads(), 3);
}

TEST_F(MeshFileTest, ACutFileIsRefused) {
  for (const char* name : {"trapdoor_q8.msh", "trapdoor_q8_v22.msh", "trapdoor_q8_bin.msh", "slope_quad4.msh"}) {
    const std::string text = text_of(mesh_path(name));
    const std::size_t whole = text.find_last_not_of('\n') + 1;
    for (std::size_t size = 0; size < whole - 8; size += size < 40 ? 1 : text.size() / 60) {
      SCOPED_TRACE(testing::Message() << name << " cut to " << size);
      expect_refused(text.substr(0, size), "");
    }
    for (std::size_t size = whole - 40; size < whole - 8; ++size) {  // within the last number, and after it
      SCOPED_TRACE(testing::Message() << name << " cut to " << size);
      expect_refused(text.substr(0, size), "");
    }
  }
}

TEST_F(MeshFileTest, CurvedMidsidesStay) {
  // Types 16 (quadrilateral of 8 nodes) and 8 (curve of 3): the lower edge is bent by 0.1.
  const std::string nodes = "1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0.5 -0.1 0\n6 1 0.5 0\n7 0.5 1 0\n8 0 0.5 0\n";
  const std::string ccw = "1 16 2 7 1 1 2 3 4 5 6 7 8\n2 8 2 5 1 1 2 5\n";
  const std::string cw = "1 16 2 7 1 1 4 3 2 8 7 6 5\n2 8 2 5 1 1 2 5\n";
  for (const std::string& elements : {ccw, cw}) {
    const Mesh mesh = read_text(file_22(nodes, elements)).mesh;
    mesh_checks::expect_sound(mesh);
    ASSERT_EQ(mesh.node_set("base").size(), 3u);
    EXPECT_EQ(mesh.coordinates.col(mesh.node_set("base")[1]), Point(0.5, -0.1));
    EXPECT_NEAR(mesh_checks::area(mesh), 1 + 2 * 0.1 / 3, 1e-14);
  }
}

TEST_F(MeshFileTest, CurvesInsideTheGroundHaveNodesAndNoEdges) {
  const MeshFile file = read_text(file_22(two_squares, two_quads + "3 1 2 6 1 5 2\n4 1 2 5 2 1 2\n5 15 2 9 1 5\n"));
  mesh_checks::expect_sound(file.mesh);
  EXPECT_EQ(file.mesh.edges.count("middle"), 0u);
  ASSERT_EQ(file.mesh.node_set("middle").size(), 3u);
  for (const int node : file.mesh.node_set("middle")) EXPECT_EQ(file.mesh.coordinates(0, node), 1);
  EXPECT_EQ(file.mesh.coordinates.col(file.mesh.point("mark")), Point(1, 1));
  EXPECT_EQ(file.mesh.unnamed_edges.size(), 5u);
  EXPECT_EQ(file.mesh.region_names, (std::vector<std::string>{"soil", "rock"}));
  EXPECT_EQ(
      file.remarks,
      (std::vector<std::string>{
          "2 elements of 4 nodes completed to 8 nodes with straight edges",
          "5 outer edges (5 m) on no physical curve: the pressure of the packings acts there",
          "1 edge of the boundary middle lies inside the ground: nodes there may be held or moved, but not pressed"}));
}

TEST_F(MeshFileTest, NodesOfNoElementAreLeftOut) {
  std::string text = text_of(mesh_path("unnamed_groups.msh"));
  text = replaced(text, "4 4 1 0\n", "5 4 1 0\n5 7 7 0 0\n");
  text = replaced(text, "9 9 1 9\n", "10 10 1 10\n0 5 0 1\n10\n7 7 0\n");
  const MeshFile file = read_text(text);
  EXPECT_EQ(file.mesh.coordinates, read("unnamed_groups.msh").mesh.coordinates);
  ASSERT_EQ(file.remarks.size(), 2u);
  EXPECT_EQ(file.remarks[1], "1 node of no element left out");
}

TEST_F(MeshFileTest, FaultsNameTheirPlace) {
  expect_refused(file_22(two_squares, two_quads + "3 1 2 5 1 1 2\n4 1 2 6 2 2 1\n"),
                 "the edge from (0, 0) to (1, 0) is on the boundaries base and middle");
  expect_refused(file_22(two_squares, two_quads + "3 3 2 7 1 1 2 5 4\n4 3 2 7 1 1 2 5 4\n"),
                 "an edge belongs to more than two elements: from (0, 0) to (1, 0)");
  expect_refused(file_22(two_squares, replaced(two_quads, "3 6 5", "3 6 77")),
                 "element 2 has the node 77, which the file lacks");
  expect_refused(replaced(text_of(mesh_path("unnamed_groups.msh")), "9 1 5 9 8", "9 1 5 9 88"), "Unknown node 88");
  expect_refused(file_22("1 0 0 0\n2 3 0 0\n3 0.5 0.5 0\n4 0 3 0\n", "61 3 2 7 1 1 2 3 4\n"), "element 61 is folded");
  expect_refused(file_22(replaced(two_squares, "3 2 0", "3 nan 0"), two_quads),
                 "node 3 has a coordinate that is not finite");
  expect_refused(file_22("", ""), "the file has no quadrilaterals");
  expect_refused(file_22("7 5 5 0\n" + two_squares, two_quads + "3 15 2 9 1 7\n"),
                 "the point mark is a corner of no element");
  // One edge beside two: a corner in the middle of the edge.
  expect_refused(file_22("1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 2 0 0\n6 2 0.5 0\n7 1 0.5 0\n8 2 1 0\n",
                         "1 3 2 7 1 1 2 3 4\n2 3 2 7 1 2 5 6 7\n3 3 2 7 1 7 6 8 3\n"),
                 "1 node lies on edges of other elements (first at (1, 0.5)): the surfaces are not glued");
  const std::string unnamed = text_of(mesh_path("unnamed_groups.msh"));
  expect_refused(replaced(unnamed, " 2 2 0 1 7 ", " 2 2 0 2 7 8 "), "is in the regions 7 and 8");
  expect_refused(file_22("1 0 0 0\n2 2 0 0\n3 2 2 0\n4 0 2 0\n5 1 0 0\n6 2 1 0\n7 1 2 0\n8 0 1 0\n9 1 1 0\n",
                         "1 10 2 7 1 1 2 3 4 5 6 7 8 9\n"),
                 "quadrilaterals of 9 nodes; in Gmsh: Mesh.SecondOrderIncomplete = 1");
}

}  // namespace
}  // namespace voussoir::fem
