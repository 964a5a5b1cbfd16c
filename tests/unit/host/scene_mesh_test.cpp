#include "host/scene/scene_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "fem/mesh_grid.hpp"
#include "fem/mesh_rectangle.hpp"
#include "fem/mesh_tunnel.hpp"
#include "tests/mesh_checks.hpp"
#include "tests/throws.hpp"

namespace voussoir::host {
namespace {

using fem::Mesh;
using mesh_checks::is_closed;
using mesh_checks::length;
using mesh_checks::pieces;
using mesh_checks::region_area;

SceneMeshCase small_grid() {
  SceneMeshCase m;
  m.x = {-1, 2, 3, 5};
  m.columns = {4, 3, 5};
  m.x_ratio = {0.85, 1, 1.2};
  m.y = {0, 1, 1.5};
  m.rows = {3, 2};
  m.y_ratio = {1.1, 1};
  m.base = {"floor", "door", "floor"};
  m.layers = {"sand", "clay"};
  return m;
}

SceneMeshCase tunnel_of(MeshShape shape) {
  SceneMeshCase m;
  m.shape = shape;
  m.width = shape == MeshShape::tunnel ? 60 : 30;
  m.height = 30;
  m.size_opening = 1.2;
  m.size_far = 6;
  return m;
}

SceneMeshCase small_ring(RingPart part) {
  SceneMeshCase m;
  m.shape = MeshShape::ring;
  m.radius = 0.5;
  m.outer = 4;
  m.ring_columns = 12;
  m.ring_rows = 5;
  m.ratio = 1.3;
  m.part = part;
  return m;
}

void expect_refused(const SceneMeshCase& mesh, const std::string& sentence) {
  expect_throws<std::runtime_error>([&] { static_cast<void>(scene_mesh(mesh)); }, sentence);
}

TEST(SceneMesh, GridHasItsLinesBoundariesAndLayers) {
  const Mesh mesh = scene_mesh(small_grid());
  mesh_checks::expect_sound(mesh);
  EXPECT_EQ(mesh.n_elements(), 12 * 5);
  EXPECT_NEAR(mesh_checks::area(mesh), 6 * 1.5, 1e-12);
  EXPECT_NEAR(length(mesh, "floor"), 5, 1e-12);
  EXPECT_EQ(pieces(mesh, "floor"), 2);
  EXPECT_NEAR(length(mesh, "door"), 1, 1e-12);
  EXPECT_NEAR(length(mesh, "top"), 6, 1e-12);
  EXPECT_NEAR(length(mesh, "left"), 1.5, 1e-12);
  EXPECT_EQ(mesh.edges.size(), 5u);
  EXPECT_TRUE(mesh.unnamed_edges.empty());
  EXPECT_NEAR(region_area(mesh, "sand"), 6, 1e-12);
  EXPECT_NEAR(region_area(mesh, "clay"), 3, 1e-12);
  EXPECT_EQ(mesh.coordinates.col(mesh.point("base_left")), fem::Point(-1, 0));
  EXPECT_EQ(mesh.coordinates.col(mesh.point("base_right")), fem::Point(5, 0));
  EXPECT_EQ(mesh.coordinates.col(mesh.point("top_left")), fem::Point(-1, 1.5));
  EXPECT_EQ(mesh.coordinates.col(mesh.point("top_right")), fem::Point(5, 1.5));
  // The ratio is that of an element's length to the one to its left.
  const auto edge_length = [&](int k) {
    const fem::Edge& edge = mesh.edge_set("floor")[k];
    return mesh.coordinates(0, edge[2]) - mesh.coordinates(0, edge[0]);
  };
  EXPECT_NEAR(edge_length(1) / edge_length(0), 0.85, 1e-12);
  EXPECT_NEAR(edge_length(8) / edge_length(7), 1.2, 1e-12);
}

TEST(SceneMesh, GridOfOneIntervalIsTheRectangle) {
  SceneMeshCase m;
  m.x = {0, 3.1};
  m.columns = {7};
  m.x_ratio = {1};
  m.y = {0, 0.7};
  m.rows = {12};
  m.y_ratio = {1};
  const Mesh mesh = scene_mesh(m);
  const Mesh rectangle = fem::make_rectangle(3.1, 0.7, 7, 12);
  EXPECT_EQ(mesh.coordinates, rectangle.coordinates);
  EXPECT_EQ(mesh.elements, rectangle.elements);
  EXPECT_EQ(mesh.edge_set("base"), rectangle.edge_set("base"));
  EXPECT_EQ(mesh.edge_set("right"), rectangle.edge_set("side"));
  EXPECT_EQ(mesh.node_set("left"), rectangle.node_set("axis"));
}

TEST(SceneMesh, OneBoundaryMayGoRoundCorners) {
  SceneMeshCase m = small_grid();
  m.base = {"box"};
  m.left = m.right = {"box", "box"};
  const Mesh mesh = scene_mesh(m);
  mesh_checks::expect_sound(mesh);
  EXPECT_EQ(pieces(mesh, "box"), 1);
  EXPECT_EQ(mesh.edge_set("box").front()[0], mesh.point("top_left"));
  EXPECT_EQ(mesh.edge_set("box").back()[2], mesh.point("top_right"));
  m.top = {"box"};
  const Mesh closed = scene_mesh(m);
  EXPECT_TRUE(is_closed(closed, "box"));
  EXPECT_EQ(closed.node_set("box").size(), 2 * closed.edge_set("box").size());
}

TEST(SceneMesh, StronglyGradedLinesStayFinite) {
  for (const double ratio : {0.5, 2.0, 1 + 1e-13}) {
    const std::vector<double> line = fem::graded_line(0, 1, 40, ratio);
    EXPECT_EQ(line.front(), 0);
    EXPECT_EQ(line.back(), 1);
    for (std::size_t k = 2; k < line.size(); ++k)
      EXPECT_NEAR((line[k] - line[k - 1]) / (line[k - 1] - line[k - 2]), ratio, 1e-3) << ratio << " " << k;
  }
}

TEST(SceneMesh, HalfTunnelIsThatOfTheKindTunnel) {
  const Mesh mesh = scene_mesh(tunnel_of(MeshShape::half_tunnel));
  const Mesh kind = fem::make_half_tunnel({.width = 30, .height = 30, .size_near = 1.2, .size_far = 6});
  EXPECT_EQ(mesh.coordinates, kind.coordinates);
  EXPECT_EQ(mesh.elements, kind.elements);
  EXPECT_EQ(mesh.edge_set("right"), kind.edge_set("side"));
  EXPECT_EQ(mesh.node_set("opening"), kind.node_set("opening"));
  EXPECT_EQ(mesh.points, kind.points);
  EXPECT_EQ(mesh.edges.count("side"), 0u);
  EXPECT_EQ(mesh.region_names, std::vector<std::string>{"ground"});
  EXPECT_EQ(pieces(mesh, "axis"), 2);
  mesh_checks::expect_sound(mesh);
}

TEST(SceneMesh, TunnelIsTheHalfAndItsImage) {
  const Mesh mesh = scene_mesh(tunnel_of(MeshShape::tunnel));
  const Mesh half = scene_mesh(tunnel_of(MeshShape::half_tunnel));
  mesh_checks::expect_sound(mesh);
  EXPECT_EQ(mesh.n_elements(), 2 * half.n_elements());
  EXPECT_NEAR(mesh_checks::area(mesh), 2 * mesh_checks::area(half), 1e-9);
  EXPECT_TRUE(is_closed(mesh, "opening"));
  EXPECT_LT(fem::area_left_of(mesh.coordinates, mesh.edge_set("opening")), 0);  // clockwise
  EXPECT_EQ(mesh.edge_set("opening").front()[0], mesh.point("crown"));
  EXPECT_EQ(mesh.coordinates.col(mesh.point("crown")), half.coordinates.col(half.point("crown")));
  EXPECT_EQ(mesh.coordinates.col(mesh.point("invert")), half.coordinates.col(half.point("invert")));
  EXPECT_NEAR(length(mesh, "base"), 60, 1e-12);
  EXPECT_EQ(mesh.edges.size(), 5u);
  for (const int node : mesh.node_set("left")) EXPECT_EQ(mesh.coordinates(0, node), -30);
  for (const int node : mesh.node_set("right")) EXPECT_EQ(mesh.coordinates(0, node), 30);
}

/// Every line between layers has the nodes of whole element edges across the ground.
void expect_line(const Mesh& mesh, double height, double width) {
  double covered = 0;
  for (const fem::ElementNodes& e : mesh.elements)
    for (int k = 0; k < 4; ++k) {
      const fem::Point a = mesh.coordinates.col(e[k]);
      const fem::Point b = mesh.coordinates.col(e[(k + 1) % 4]);
      if (a.y() == height && b.y() == height && b.x() > a.x()) covered += b.x() - a.x();  // elements above
    }
  EXPECT_NEAR(covered, width, 1e-9);
}

TEST(SceneMesh, LayersOfATunnelHaveLinesBetweenThem) {
  // The opening reaches from 15 to 20 m: lines below, through (also at the springline) and above it.
  for (const MeshShape shape : {MeshShape::half_tunnel, MeshShape::tunnel}) {
    const int halves = shape == MeshShape::tunnel ? 2 : 1;
    SceneMeshCase m = tunnel_of(shape);
    m.interfaces = {10, 17.5, 19, 24};
    m.layers = {"rock", "gravel", "sand", "gravel", "fill"};
    const Mesh mesh = scene_mesh(m);
    mesh_checks::expect_sound(mesh);
    EXPECT_EQ(mesh.region_names, (std::vector<std::string>{"rock", "gravel", "sand", "fill"}));
    EXPECT_NEAR(region_area(mesh, "rock"), halves * 300, 1e-9);
    EXPECT_NEAR(region_area(mesh, "fill"), halves * 180, 1e-9);
    EXPECT_NEAR(mesh_checks::area(mesh), halves * (900 - M_PI * 25 / 8), 1e-2);
    expect_line(mesh, 10, halves * 30);
    expect_line(mesh, 17.5, halves * 27.5);
    expect_line(mesh, 19, halves * (30 - std::sqrt(2.5 * 2.5 - 1.5 * 1.5)));
    expect_line(mesh, 24, halves * 30);
    const fem::Point centre(0, 17.5);
    for (const int node : mesh.node_set("opening"))
      EXPECT_NEAR((mesh.coordinates.col(node) - centre).norm(), 2.5, 1e-13);
  }
}

TEST(SceneMesh, RingLiesOnCircles) {
  for (const RingPart part : {RingPart::quarter, RingPart::half, RingPart::whole}) {
    const double quarters = part == RingPart::quarter ? 1 : part == RingPart::half ? 2 : 4;
    const Mesh mesh = scene_mesh(small_ring(part));
    mesh_checks::expect_sound(mesh);
    EXPECT_EQ(mesh.n_elements(), 60);
    for (const int node : mesh.node_set("cavity")) EXPECT_NEAR(mesh.coordinates.col(node).norm(), 0.5, 1e-15);
    for (const int node : mesh.node_set("far")) EXPECT_NEAR(mesh.coordinates.col(node).norm(), 4, 1e-14);
    EXPECT_NEAR(mesh_checks::area(mesh), quarters * M_PI / 4 * (16 - 0.25), 2e-2);
    EXPECT_EQ(mesh.region_names, std::vector<std::string>{"ground"});
    const bool is_whole = part == RingPart::whole;
    EXPECT_EQ(mesh.edges.count("x0"), is_whole ? 0u : 1u);
    EXPECT_EQ(mesh.edges.count("y0"), part == RingPart::quarter ? 1u : 0u);
    EXPECT_EQ(is_closed(mesh, "cavity"), is_whole);
    EXPECT_EQ(is_closed(mesh, "far"), is_whole);
    if (is_whole) continue;
    EXPECT_EQ(pieces(mesh, "x0"), part == RingPart::half ? 2 : 1);
    for (const int node : mesh.node_set("x0")) EXPECT_EQ(mesh.coordinates(0, node), 0);
  }
}

SceneMeshCase mesh_file(const std::string& name) {
  SceneMeshCase m;
  m.shape = MeshShape::file;
  m.file = std::string(VOUSSOIR_SOURCE_DIR) + "/tests/meshes/" + name;
  return m;
}

TEST(SceneMesh, AFileHasItsRemarksAndItsKey) {
  const SceneMesh slope = scene_mesh_with_remarks(mesh_file("slope_quad4.msh"));
  EXPECT_NEAR(region_area(slope.mesh, "bank"), 75, 1e-9);
  EXPECT_EQ(slope.remarks,
            std::vector<std::string>{"170 elements of 4 nodes completed to 8 nodes with straight edges"});
  SceneMeshCase in_millimetres = mesh_file("slope_quad4.msh");
  in_millimetres.unit = 1e-3;
  EXPECT_NEAR(region_area(scene_mesh(in_millimetres), "bank"), 75e-6, 1e-15);
  in_millimetres.unit = 0;
  expect_refused(in_millimetres, "mesh.unit: it must be positive and finite");
  expect_refused(mesh_file("bad_text.msh"),
                 "mesh.file: bad_text.msh is no Gmsh mesh: its first line is not $MeshFormat");
  expect_refused(mesh_file("bad_no_groups.msh"), "mesh.file: no physical surface");
}

TEST(SceneMesh, ImpossibleShapesNameTheirKey) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto grid = [](auto change) {
    SceneMeshCase m = small_grid();
    change(m);
    return m;
  };
  expect_refused(grid([](auto& m) { m.x = {1}; }), "mesh.x: at least two breakpoints");
  expect_refused(grid([](auto& m) { m.x[1] = -1; }), "mesh.x: the breakpoints must ascend");
  expect_refused(grid([&](auto& m) { m.y[1] = nan; }), "mesh.y: a breakpoint must be finite");
  expect_refused(grid([](auto& m) { m.columns = {1, 2}; }), "mesh.columns: 2 numbers for 3 intervals of x");
  expect_refused(grid([](auto& m) { m.rows = {1, 0}; }), "mesh.rows: at least one element");
  expect_refused(grid([](auto& m) { m.rows = {1, 3000000}; }), "mesh.rows: more than two million elements");
  expect_refused(grid([](auto& m) { m.rows = {1000, 200000}; }),
                 "mesh.rows: the grid would have more than two million");
  expect_refused(grid([](auto& m) { m.x_ratio = {1, 2}; }), "mesh.x_ratio: 2 ratios for 3 intervals");
  expect_refused(grid([](auto& m) { m.y_ratio = {0, 1}; }), "mesh.y_ratio: a ratio of lengths");
  expect_refused(grid([](auto& m) { m.x_ratio = {100, 1, 1}, m.columns = {50, 1, 1}; }), "mesh.x_ratio: the smallest");
  expect_refused(grid([](auto& m) { m.base = {"a", "b"}; }), "mesh.base: 2 names for 3 intervals");
  expect_refused(grid([](auto& m) { m.right = {"a", ""}; }), "mesh.right: a name must not be empty");
  expect_refused(grid([](auto& m) { m.layers = {"a", "b", "c"}; }), "mesh.layers: 3 names for 2 intervals");

  const auto tunnel = [](auto change) {
    SceneMeshCase m = tunnel_of(MeshShape::half_tunnel);
    change(m);
    return m;
  };
  expect_refused(tunnel([&](auto& m) { m.width = nan; }), "mesh.width: it must be positive");
  expect_refused(tunnel([](auto& m) { m.cover_ratio = 6; }), "mesh.cover_ratio: the invert lies below the base");
  expect_refused(tunnel([](auto& m) { m.width = 2; }), "mesh.width: the tunnel is wider");
  expect_refused(tunnel([](auto& m) { m.size_opening = 3; }), "mesh.size_opening: it is more than half");
  expect_refused(tunnel([](auto& m) { m.size_far = 1; }), "mesh.size_far: it is smaller");
  expect_refused(tunnel([](auto& m) { m.size_opening = 1e-4; }), "mesh.size_opening: the element sizes");
  expect_refused(tunnel([](auto& m) { m.interfaces = {20}; }), "mesh.interfaces: an interface must be half");
  expect_refused(tunnel([](auto& m) { m.interfaces = {5, 5}; }), "mesh.interfaces: the interfaces must ascend");
  expect_refused(tunnel([](auto& m) { m.layers = {"a", "b"}; }), "mesh.layers: 2 names for 1 layers");

  const auto ring = [](auto change) {
    SceneMeshCase m = small_ring(RingPart::quarter);
    change(m);
    return m;
  };
  expect_refused(ring([](auto& m) { m.radius = -1; }), "mesh.radius: it must be positive");
  expect_refused(ring([](auto& m) { m.outer = 0.5; }), "mesh.outer: it must be larger");
  expect_refused(ring([](auto& m) { m.ring_columns = 0; }), "mesh.columns: at least one element");
  expect_refused(ring([](auto& m) { m.ring_rows = 2000000; }), "mesh.rows: the ring would have");
  expect_refused(ring([](auto& m) { m.ratio = 0; }), "mesh.ratio: a ratio of lengths");
}

}  // namespace
}  // namespace voussoir::host
