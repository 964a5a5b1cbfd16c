// Points of scenes that are held, moved and released, and where what holds the ground pulls it.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "host/scene/boundary_columns.hpp"
#include "tests/scene_support.hpp"
#include "tests/throws.hpp"

namespace voussoir::host {
namespace {

constexpr double p0 = 1e3;     ///< [Pa]
constexpr double stiff = 5e9;  ///< so that the ground stays nearly as drawn [Pa]

/// 4 x 2 m of two layers, held at the base and on the left.
Scene bed() {
  Scene scene = scene_on(grid(4, 2, 4, 2, {"lower", "upper"}), 20e3, p0);
  scene.input.supports = {support({"base"}, "xy"), support({"left"}, "x")};
  return scene;
}

PlaceCase place(const std::string& name) { return {.name = name, .at = {}}; }

ReleaseCase release_of(PlaceCase point, double share = 1) {
  return {.boundary = "", .point = std::move(point), .share = share};
}

ReleaseCase release_of(const std::string& boundary, double share = 1) {
  return {.boundary = boundary, .point = {}, .share = share};
}

StageCase moved(const std::string& name, std::vector<ReleaseCase> releases) {
  StageCase one = stage(name, 2);
  one.geometry = LossGeometry::updated_lagrangian;
  one.releases = std::move(releases);
  return one;
}

/// All or a part of the force on a point goes; what is free at the end has moved as if nothing had ever held it.
TEST(Points, AreReleasedAtOnceAndInParts) {
  Scene scene = bed();
  scene.input.stages = {moved("load", {})};
  scene.input.stages[0].presses = {pressure_on("top", 50e3)};
  const int corner = scene.mesh.point("top_right");
  const auto displacements = [&](const char* folder) {
    std::vector<fem::Point> all;
    for (const StageEnd& end : ElasticRun{.scene = scene, .young = stiff}.run(folder))
      all.emplace_back(end.displacement.segment<2>(2 * corner));
    return all;
  };
  const fem::Point free = displacements("points_free").back();
  ASSERT_GT(free.norm(), 1e-6);

  scene.input.supports.push_back(point_support({.name = "", .at = {4, 2}}, "xy"));
  const StageCase load = scene.input.stages[0];
  scene.input.stages = {load, moved("part", {release_of(place("top_right"), 0.4)}), moved("wait", {}),
                        moved("rest", {release_of(place("top_right"))})};
  scene.input.stages[2].tilt = 0.0;
  const std::vector<fem::Point> parts = displacements("points_parts");
  EXPECT_LT(parts[0].norm(), 1e-12);
  EXPECT_LT((parts[1] - 0.4 * free).norm(), 1e-3 * free.norm());
  EXPECT_LT((parts[2] - parts[1]).norm(), 1e-3 * free.norm());
  EXPECT_LT((parts[3] - free).norm(), 1e-3 * free.norm());
}

TEST(Points, AreGivenBackToTheBoundaryThatHeldThem) {
  Scene scene = bed();
  const int corner = scene.mesh.point("top_left");
  scene.input.supports.push_back(point_support(place("top_left"), "xy"));
  scene.input.stages = {moved("let_go", {release_of(place("top_left"))})};
  const StagePlan plan = plan_stages(scene).front();
  EXPECT_EQ(plan.holders[plan.owners.at(2 * corner)].name, "left");
  EXPECT_FALSE(plan.fading.contains(2 * corner));
  EXPECT_TRUE(plan.fading.contains(2 * corner + 1));
  EXPECT_EQ(plan.fading.size(), 1U);
}

/// A release of a point leaves the loads of the edges without a name alone.
TEST(Points, HaveNoLoadOfTheirOwn) {
  Scene scene = bed();
  scene.mesh.unnamed_edges = scene.mesh.edges.at("top");
  scene.mesh.edges.erase("top");
  scene.mesh.nodes.erase("top");
  scene.input.supports.push_back(point_support(place("top_right"), "y"));
  scene.input.stages = {moved("let_go", {release_of(place("top_right"))})};
  EXPECT_EQ(plan_stages(scene).front().load_of("")->pressure_to[1], p0);
}

void expect_refused(const Scene& scene, const std::string& sentence) {
  expect_throws<std::runtime_error>([&] { static_cast<void>(plan_stages(scene)); }, sentence);
}

TEST(Points, AreRefusedWhereNothingHoldsThem) {
  Scene scene = bed();
  scene.input.stages = {moved("let_go", {release_of(place("base_left"))})};
  expect_refused(scene, "stage[0].release[0].point: nothing holds base_left as a point");
  scene.input.stages = {moved("let_go", {release_of({.name = "", .at = {4, 2}})})};
  expect_refused(scene, "stage[0].release[0].point: nothing holds the point (4, 2) m as a point");
  scene.input.stages = {moved("let_go", {release_of({.name = "", .at = {3.9, 2}})})};
  expect_refused(scene, "stage[0].release[0].point: no node of the mesh lies at (3.9, 2) m");
  scene.input.supports.push_back(point_support(place("top_right"), "y"));
  scene.input.stages = {moved("let_go", {release_of(place("top_right"), 0.5), release_of({.name = "", .at = {4, 2}})})};
  expect_refused(scene, "stage[0].release[1].point: names the point (4, 2) m for the second time in this stage");
}

/// Where the ground is dug out, so is the point that was held there.
TEST(Points, ThatAreDugOutAreHeldNoLonger) {
  Scene scene = bed();
  scene.input.supports.push_back(point_support({.name = "", .at = {4, 2}}, "y"));
  StageCase dig = moved("dig", {});
  dig.excavations = {{.regions = {"upper"}}};
  scene.input.stages = {dig, moved("let_go", {release_of(place("top_right"))})};
  expect_refused(scene, "stage[1].release[0].point: nothing holds top_right as a point");
}

/// What is left of a force after a release in part goes with the ground.
TEST(Releases, OfWhatHasBeenDugOutAreRefused) {
  Scene scene = bed();
  scene.input.supports.push_back(support({"top"}, "y"));
  scene.input.supports.push_back(point_support(place("top_right"), "xy"));
  StageCase dig = moved("dig", {});
  dig.excavations = {{.regions = {"upper"}}};
  const auto sentence = [](int stage, int number, const std::string& rest) {
    return "stage[" + std::to_string(stage) + "].release[" + std::to_string(number) + "]." + rest;
  };
  const std::vector<ReleaseCase> parts{release_of(place("top_right"), 0.5), release_of("top", 0.5)};
  for (const ReleaseCase& rest : {release_of(place("top_right")), release_of("top")}) {
    const std::string refused = rest.boundary.empty() ? "point: nothing holds top_right as a point"
                                                      : "boundary: nothing holds top";
    scene.input.stages = {dig, moved("let_go", {rest})};
    expect_refused(scene, sentence(1, 0, refused));
    scene.input.stages = {moved("part", parts), dig, moved("let_go", {rest})};
    expect_refused(scene, sentence(2, 0, refused));
    scene.input.stages = {moved("part", parts), moved("let_go", {rest})};
    EXPECT_EQ(plan_stages(scene).size(), 2U);
  }
}

/// Where several releases of a stage meet at a node, the share of the node's owner counts, in any order of the tables.
TEST(Releases, ShareTheirNodesByTheOwner) {
  Scene scene = bed();
  scene.input.supports.push_back(support({"top", "right"}, "xy"));
  scene.input.supports.push_back(point_support(place("top_right"), "x"));
  const int corner = scene.mesh.point("top_right");
  std::vector<ReleaseCase> releases{release_of(place("top_right"), 0.1), release_of("top", 0.3), release_of("right")};
  std::vector<StagePlan> plans;
  for (int k = 0; k < 3; ++k) {
    std::rotate(releases.begin(), releases.begin() + 1, releases.end());
    for (int turn = 0; turn < 2; ++turn) {
      std::swap(releases[0], releases[1]);
      scene.input.stages = {moved("let_go", releases)};
      plans.push_back(plan_stages(scene).front());
    }
  }
  for (const StagePlan& plan : plans) {
    EXPECT_EQ(plan.fading.at(2 * corner), 0.1);    // of the point
    EXPECT_EQ(plan.fading.at(2 * corner + 1), 1);  // of "right", which comes after "top"
    EXPECT_EQ(plan.fading, plans.front().fading);
    EXPECT_EQ(plan.part_released, plans.front().part_released);
  }
}

/// Reactions of this force [N/m] at each of the nodes.
Eigen::VectorXd reactions_of(const Scene& scene, const std::vector<int>& nodes, const fem::Point& force) {
  Eigen::VectorXd reactions = Eigen::VectorXd::Zero(scene.mesh.n_dofs());
  for (const int node : nodes) reactions.segment<2>(2 * node) = force;
  return reactions;
}

using Counts = std::map<std::string, int>;

Counts pulled(const Scene& scene, const StagePlan& plan, const std::vector<int>& nodes, const fem::Point& force) {
  Counts counts;
  const Eigen::VectorXd reactions = reactions_of(scene, nodes, force);
  for (const auto& [name, found] : tensile_nodes(scene.mesh, plan, reactions, scene.mesh.coordinates))
    counts[name] = static_cast<int>(found.size());
  return counts;
}

TEST(Tension, IsCountedOfBoundariesAndOfPoints) {
  Scene scene = bed();
  const int corner = scene.mesh.point("top_right");
  scene.input.supports.push_back(point_support(place("top_right"), "y"));
  scene.input.supports.push_back(point_support({.name = "", .at = {4, 1}}, "x"));
  scene.input.stages = {stage("rest")};
  const StagePlan plan = plan_stages(scene).front();
  const int side = plan.holders.back().nodes.front();
  const std::vector<int>& left = scene.mesh.node_set("left");
  EXPECT_EQ(pulled(scene, plan, left, {-1e3, 0}), (Counts{{"left", static_cast<int>(left.size())}}));
  EXPECT_EQ(pulled(scene, plan, left, {1e3, 0}), Counts{});
  EXPECT_EQ(pulled(scene, plan, {corner, side}, {1e3, 1e3}), (Counts{{"the point (4, 1) m", 1}, {"top_right", 1}}));
  EXPECT_EQ(pulled(scene, plan, {corner, side}, {-1e3, -1e3}), Counts{});
}

/// A force on a curve or a point with ground on both sides has no outward direction; it has one when one side is gone.
TEST(Tension, InsideTheGroundIsCountedOnceOneSideIsDugOut) {
  Scene scene = bed();
  std::vector<int>& curve = scene.mesh.nodes["curve"];
  for (int node = 0; node < scene.mesh.n_nodes(); ++node)
    if (scene.mesh.coordinates(1, node) == 1 && scene.mesh.coordinates(0, node) >= 1) curve.push_back(node);
  scene.input.supports.push_back(support({"curve"}, "y"));
  scene.input.supports.push_back(point_support({.name = "", .at = {0.5, 1}}, "y"));
  StageCase dig = moved("dig", {});
  dig.excavations = {{.regions = {"upper"}}};
  scene.input.stages = {stage("rest"), dig};
  const std::vector<StagePlan> plans = plan_stages(scene);
  std::vector<int> nodes = curve;
  nodes.push_back(plans[0].holders.back().nodes.front());
  for (const double force : {-1e3, 1e3}) EXPECT_EQ(pulled(scene, plans[0], nodes, {0, force}), Counts{}) << force;
  const Counts all{{"curve", static_cast<int>(curve.size())}, {"the point (0.5, 1) m", 1}};
  EXPECT_EQ(pulled(scene, plans[1], nodes, {0, 1e3}), all);
  EXPECT_EQ(pulled(scene, plans[1], nodes, {0, -1e3}), Counts{});
}

}  // namespace
}  // namespace voussoir::host
