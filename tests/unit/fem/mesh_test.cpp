#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "fem/gauss_points.hpp"
#include "fem/mesh.hpp"
#include "fem/mesh_rectangle.hpp"
#include "fem/mesh_tunnel.hpp"
#include "tests/mesh_checks.hpp"
#include "tests/throws.hpp"

namespace voussoir::fem {
namespace {

using mesh_checks::expect_closed_outline;

void check_tunnel(const HalfTunnelOptions& o) {
  SCOPED_TRACE(testing::Message() << "C/D " << o.cover / o.diameter << " size " << o.size_near);
  const Mesh mesh = make_half_tunnel(o);
  expect_closed_outline(mesh);
  const GaussPoints points = gauss_points(mesh, mesh.coordinates);
  for (int e = 0; e < mesh.n_elements(); ++e) {
    const auto first = points.volumes.begin() + 4 * e;
    EXPECT_GT(*std::min_element(first, first + 4), 0.15 * *std::max_element(first, first + 4));
  }
  const Point centre(0, o.height - o.cover - o.diameter / 2);
  for (const int node : mesh.node_set("opening"))
    EXPECT_NEAR((mesh.coordinates.col(node) - centre).norm(), o.diameter / 2, 1e-14 * o.height);
  for (const int node : mesh.node_set("axis")) EXPECT_EQ(mesh.coordinates(0, node), 0);
  EXPECT_EQ(mesh.coordinates(0, mesh.point("crown")), 0);
  EXPECT_EQ(mesh.coordinates(0, mesh.point("invert")), 0);
  EXPECT_NEAR(mesh.coordinates(1, mesh.point("crown")), o.height - o.cover, 1e-12);
  EXPECT_NEAR(mesh.coordinates(1, mesh.point("invert")), o.height - o.cover - o.diameter, 1e-12);
  double previous = 1e300;
  for (const int node : mesh.node_set("opening")) {  // from crown to invert
    EXPECT_LT(mesh.coordinates(1, node), previous);
    previous = mesh.coordinates(1, node);
  }
  // The Q8 edges' area against the half circle's: the arc of angle a is missed by about a^5.
  EXPECT_NEAR(-area_left_of(mesh.coordinates, mesh.edge_set("opening")), M_PI * o.diameter * o.diameter / 8,
              1e-4 * o.diameter * o.diameter);
}

TEST(Mesh, InRegionAsksForTheNameAndWithoutNamesAnswersToAny) {
  Mesh mesh = make_rectangle(1, 2, 1, 2);
  EXPECT_TRUE(mesh.in_region(0, "sand"));
  mesh.region_names = {"sand", "rock"};
  mesh.region = {1, 0};
  EXPECT_TRUE(mesh.in_region(0, "rock"));
  EXPECT_TRUE(mesh.in_region(1, "sand"));
  EXPECT_FALSE(mesh.in_region(1, "rock"));
  EXPECT_FALSE(mesh.in_region(0, "gravel"));
}

TEST(TunnelMesh, IsSoundForAnyCoverAndFineness) {
  for (const double ratio : {0.5, 1.0, 2.0, 3.0, 4.0, 5.5})
    for (const double size : {0.25, 0.5, 1.1, 2.2})
      check_tunnel({.cover = 5 * ratio, .size_near = size, .size_far = std::max(2.5, size)});
  check_tunnel({.width = 60, .height = 80, .diameter = 8, .cover = 30, .size_near = 0.7, .size_far = 6});
}

TEST(TunnelMesh, RepeatsItsBits) {
  for (const double cover : {10.0, 15.0, 20.0}) {
    const Mesh a = make_half_tunnel({.cover = cover});
    static_cast<void>(make_half_tunnel({.cover = 7.5, .size_near = 0.8}));  // leaves nothing behind in Gmsh
    const Mesh b = make_half_tunnel({.cover = cover});
    EXPECT_EQ(a.coordinates, b.coordinates);
    EXPECT_EQ(a.elements, b.elements);
    EXPECT_EQ(a.edges, b.edges);
    EXPECT_EQ(a.nodes, b.nodes);
  }
}

TEST(TunnelMesh, LeavesTheThreadNumberAlone) {
  omp_set_num_threads(3);
  static_cast<void>(make_half_tunnel({.size_near = 1, .size_far = 4}));
  EXPECT_EQ(omp_get_max_threads(), 3);
}

/// The quadrilaterals of a small mesh, changed, no longer make the mesh of the options: the reason is said.
void expect_refused(const std::function<void(QuadMesh&)>& change, const char* sentence) {
  const HalfTunnelOptions options{.size_near = 2, .size_far = 8};
  QuadMesh mesh = half_tunnel_quads(options);
  change(mesh);
  expect_throws<std::runtime_error>([&] { static_cast<void>(complete_half_tunnel(options, mesh)); }, sentence);
}

TEST(TunnelMesh, QuadrilateralsOfAnotherOutlineAreRefused) {
  expect_refused([](QuadMesh& m) { m.quads.pop_back(); }, "an outer edge is on no named boundary");
  expect_refused([](QuadMesh& m) { m.corners.row(0) *= 1.01; }, "an outer edge is on no named boundary");
  expect_refused([](QuadMesh& m) { m.quads.push_back(m.quads.back()); }, "an edge belongs to more than two elements");
  expect_refused(
      [](QuadMesh& m) {  // the ground without a tunnel
        m.corners = Coordinates{{0, 35, 35, 0}, {0, 0, 35, 35}};
        m.quads = {{0, 1, 2, 3}};
      },
      "the mesh has no boundary 'opening'");
  expect_refused(
      [](QuadMesh& m) {
        for (Quad& quad : m.quads) std::swap(quad[1], quad[3]);  // clockwise
      },
      "its outline has a gap or a crossing");
}

TEST(TunnelMesh, IsFinerAtTheOpeningAndAboveIt) {
  const Mesh mesh = make_half_tunnel({});
  const auto length = [&](const Edge& e) { return (mesh.coordinates.col(e[2]) - mesh.coordinates.col(e[0])).norm(); };
  const auto& opening = mesh.edge_set("opening");
  EXPECT_NEAR(length(opening[opening.size() / 2]), 0.5, 0.03);  // 0.49 was measured
  EXPECT_LT(length(mesh.edge_set("top").back()),
            0.5 * length(mesh.edge_set("top").front()));  // above the crown, far off
}

TEST(TunnelMesh, ImpossibleOptionsSaySo) {
  expect_throws<std::invalid_argument>([&] { static_cast<void>(make_half_tunnel({.diameter = -5})); },
                                       "every length must be positive");
  expect_throws<std::invalid_argument>([&] { static_cast<void>(make_half_tunnel({.cover = 30})); }, "cover + diameter");
  expect_throws<std::invalid_argument>([&] { static_cast<void>(make_half_tunnel({.width = 2.5})); },
                                       "more than half the diameter");
  expect_throws<std::invalid_argument>([&] { static_cast<void>(make_half_tunnel({.size_near = 3})); },
                                       "size_near must not exceed size_far");
  expect_throws<std::invalid_argument>([&] { static_cast<void>(make_half_tunnel({.size_near = 3, .size_far = 4})); },
                                       "size_near must not exceed half the diameter");
  expect_throws<std::invalid_argument>([&] { static_cast<void>(make_half_tunnel({.size_near = 1e-4})); },
                                       "two million elements");
  expect_throws<std::invalid_argument>([&] { static_cast<void>(make_half_tunnel({.height = std::nan("")})); },
                                       "every length must be positive");
  expect_throws<std::invalid_argument>([&] { static_cast<void>(make_rectangle(1, 0, 2, 2)); }, "width and height");
  expect_throws<std::invalid_argument>([&] { static_cast<void>(make_rectangle(1, 1, 0, 2)); }, "nx and ny");
}

TEST(RectangleMesh, HasItsOutline) {
  const Mesh mesh = make_rectangle(3, 2, 3, 4);
  expect_closed_outline(mesh);
  EXPECT_EQ(mesh.n_elements(), 12);
  EXPECT_EQ(mesh.n_nodes(), 4 * 5 + 3 * 5 + 4 * 4);
  EXPECT_EQ(mesh.edge_set("base").size(), 3u);
  EXPECT_EQ(mesh.node_set("side").size(), 9u);
  EXPECT_EQ(mesh.coordinates(0, mesh.node_set("base").front()), 0);
  EXPECT_EQ(mesh.coordinates(0, mesh.node_set("top").front()), 3);
  expect_throws<std::out_of_range>([&] { static_cast<void>(mesh.edge_set("opening")); }, "no boundary 'opening'");
}

}  // namespace
}  // namespace voussoir::fem
