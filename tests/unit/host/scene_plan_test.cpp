// What follows from the nouns of a scene before its first increment: who owns a degree of freedom, what loads a
// boundary, which stages are refused and with which sentence.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fem/mesh_file.hpp"
#include "host/scene/boundary_columns.hpp"
#include "host/scene/rest.hpp"
#include "host/scene/scene_checks.hpp"
#include "tests/fem_support.hpp"
#include "tests/scene_support.hpp"
#include "tests/throws.hpp"

namespace voussoir::host {
namespace {

/// 4 x 2 m of two layers, held at the base and aside.
Scene bed() {
  Scene scene = scene_on(grid(4, 2, 4, 2, {"lower", "upper"}), 20e3);
  scene.input.supports = {support({"base"}, "xy"), support({"left", "right"}, "x")};
  return scene;
}

int corner(const Scene& scene, const char* name) { return scene.mesh.point(name); }

const std::string& owner(const StagePlan& plan, int node, int axis) {
  return plan.holders[plan.owners.at(2 * node + axis)].name;
}

bool is_held(const StagePlan& plan, int node, int axis) { return plan.owners.contains(2 * node + axis); }

const BoundaryLoad& load_on(const StagePlan& plan, const std::string& name) {
  return *std::find_if(plan.loads.begin(), plan.loads.end(), [&](const auto& load) { return load.boundary == name; });
}

void expect_refused(const Scene& scene, const std::string& sentence) {
  expect_throws<std::runtime_error>([&] { static_cast<void>(plan_stages(scene)); }, sentence);
}

TEST(Owners, TheLastThatNamesAnAxisOwnsIt) {
  Scene scene = bed();
  StageCase lift = stage("lift");
  lift.moves = {move_by("right", {}, 0.01)};
  scene.input.stages = {stage("rest"), lift, stage("after")};
  const std::vector<StagePlan> plans = plan_stages(scene);
  const int shared = corner(scene, "base_right");
  EXPECT_EQ(owner(plans[0], shared, 0), "right");
  EXPECT_EQ(owner(plans[0], shared, 1), "base");
  EXPECT_FALSE(is_held(plans[0], corner(scene, "top_right"), 1));
  EXPECT_EQ(owner(plans[1], shared, 1), "right");
  EXPECT_EQ(owner(plans[1], corner(scene, "top_right"), 1), "right");
  // What was moved stays where it is.
  EXPECT_EQ(owner(plans[2], shared, 1), "right");
  const Holder& held = plans[2].holders[plans[2].owners.at(2 * shared + 1)];
  EXPECT_EQ(held.displacement({4, 0}, 0, 1), fem::Point(0, 0));
}

TEST(Owners, AReleaseGivesTheAxisBackToTheOwnerBefore) {
  Scene scene = bed();
  StageCase lift = stage("lift");
  lift.moves = {move_by("right", 0.0, 0.01)};
  StageCase let_go = stage("let_go");
  let_go.releases = {{.boundary = "right"}};
  scene.input.stages = {lift, let_go};
  const std::vector<StagePlan> plans = plan_stages(scene);
  const int shared = corner(scene, "base_right");
  EXPECT_EQ(owner(plans[1], shared, 0), "base");
  EXPECT_EQ(owner(plans[1], shared, 1), "base");
  const int free = corner(scene, "top_right");
  EXPECT_FALSE(is_held(plans[1], free, 0));
  EXPECT_TRUE(plans[1].fading.contains(2 * free));
  EXPECT_TRUE(plans[1].fading.contains(2 * free + 1));
  EXPECT_FALSE(plans[1].fading.contains(2 * shared));
}

TEST(Loads, WhatNothingHoldsCarriesThePackingsPressure) {
  Scene scene = bed();
  scene.mesh.unnamed_edges = scene.mesh.edges.at("top");
  scene.mesh.edges.erase("top");
  scene.mesh.nodes.erase("top");
  scene.input.stages = {gravity_stage()};
  const std::vector<StagePlan> plans = plan_stages(scene);
  EXPECT_EQ(load_on(plans[0], "").pressure_from[1], 1e3);
  EXPECT_EQ(load_on(plans[0], "left").pressure_from[0], 0);
  EXPECT_EQ(load_on(plans[0], "base").pressure_to[1], 0);
}

TEST(Loads, APressGoesOnFromWhatLoadsNow) {
  Scene scene = bed();
  StageCase one = stage("one"), two = stage("two"), three = stage("three");
  one.presses = {pressure_on("top", 5e3)};
  two.presses = {traction_on("top", 2e3, -7e3)};
  scene.input.stages = {one, two, three};
  const std::vector<StagePlan> plans = plan_stages(scene);
  EXPECT_EQ(load_on(plans[0], "top").pressure_from[1], 1e3);
  EXPECT_EQ(load_on(plans[0], "top").pressure_to[1], 5e3);
  EXPECT_EQ(load_on(plans[1], "top").pressure_from[1], 5e3);
  EXPECT_EQ(load_on(plans[1], "top").pressure_to[1], 0);
  EXPECT_EQ(load_on(plans[1], "top").traction_to[0], 2e3);
  EXPECT_EQ(load_on(plans[2], "top").traction_from[1], -7e3);
  EXPECT_EQ(load_on(plans[2], "top").traction_to[1], -7e3);
}

/// Nothing jumps where the tractions at rest follow another load without weights.
TEST(Loads, TractionsAtRestBeginWithWhatLoadsNow) {
  Scene scene = bed();
  StageCase press = stage("press"), settle = gravity_stage();
  press.presses = {pressure_on("right", 50e3)};
  settle.presses = {at_rest_on("right")};
  scene.input.supports = {support({"base"}, "xy"), support({"left"}, "x")};
  scene.input.stages = {press, settle};
  const std::vector<StagePlan> plans = plan_stages(scene);
  EXPECT_EQ(load_on(plans[1], "right").pressure_from[0], 50e3);
  EXPECT_EQ(load_on(plans[1], "right").rest_from[0], 0);
  EXPECT_EQ(load_on(plans[1], "right").rest_to[0], 1);
  scene.input.stages = {settle};
  const StagePlan first = plan_stages(scene).front();
  EXPECT_EQ(load_on(first, "right").pressure_from[0], 0);
  EXPECT_EQ(load_on(first, "right").rest_from[0], 1);
}

TEST(Targets, GravityGrowsGeometricallyFromTheStressThatIsThere) {
  Scene scene = bed();
  scene.input.stages = {gravity_stage(), gravity_stage(3), gravity_stage(0.5), gravity_stage(0)};
  const char* names[] = {"a", "b", "c", "d"};
  for (int k = 0; k < 4; ++k) scene.input.stages[k].name = names[k];
  const std::vector<StagePlan> plans = plan_stages(scene);
  EXPECT_NEAR(plans[0].targets.front(), 0.5 * 1e3 / 40e3, 1e-12);
  EXPECT_NEAR(plans[1].targets.front(), scene.gravity.uniform_step, 1e-12);  // it stands under more than such a step
  for (const StagePlan& plan : plans) {
    EXPECT_EQ(plan.targets.back(), 1);
    EXPECT_TRUE(std::is_sorted(plan.targets.begin(), plan.targets.end()));
  }
  EXPECT_EQ(plans[2].gravity_from, 3);
  EXPECT_EQ(plans[3].gravity_to, 0);
}

TEST(Targets, WithoutWeightsAreFinite) {
  Scene scene = bed();
  for (RegionCase& region : scene.input.regions) region.unit_weight = 0;
  scene.input.stages = {gravity_stage()};
  EXPECT_EQ(plan_stages(scene).front().targets.back(), 1);
}

/// The residual of state 0 at free degrees of freedom over the largest nodal load.
double residual_at_start(const Scene& scene) {
  const std::vector<StagePlan> plans = plan_stages(scene);
  const auto n = static_cast<std::size_t>(scene.mesh.n_points());
  fem::LinearElastic material(n, {.initial_stress = fem::Stress(-scene.pressure, -scene.pressure, 0)});
  Ground ground{scene.mesh, material, {}, {}};
  begin_stage(ground);
  const SceneLoads loads(scene, plans[0], ground, nullptr);
  const Eigen::VectorXd force = loads.of_stage(0);
  const std::vector<fem::Stress> stress(n, fem::Stress(-scene.pressure, -scene.pressure, 0));
  const Eigen::VectorXd
      inside = fem::internal_force(scene.mesh, fem::gauss_points(scene.mesh, scene.mesh.coordinates), stress).force;
  double largest = 0;
  for (Eigen::Index dof = 0; dof < force.size(); ++dof) {
    if (!plans[0].owners.contains(static_cast<int>(dof)))
      largest = std::max(largest, std::abs(force[dof] - inside[dof]));
  }
  return largest / force.cwiseAbs().maxCoeff();
}

TEST(StateZero, IsInEquilibriumInAnyGeometry) {
  Scene slope = scene_on(
      fem::read_mesh_file(std::filesystem::path(VOUSSOIR_SOURCE_DIR) / "tests/meshes/slope_quad4.msh", 1.0).mesh, 20e3);
  slope.input.supports = {support({"base"}, "xy"), support({"left", "right"}, "x")};
  slope.input.stages = {gravity_stage()};
  EXPECT_LT(residual_at_start(slope), 1e-12);

  Scene distorted = bed();
  distorted.mesh.coordinates = fem_support::mapped(distorted.mesh, [](const fem::Point& x) {
                                 return fem::Point(x.x() + 0.1 * std::sin(3 * x.y()), x.y() + 0.2 * std::sin(x.x()));
                               }).coordinates;
  distorted.input.supports = {point_support({.name = "base_left", .at = {}}, "xy"),
                              point_support({.name = "base_right", .at = {}}, "y")};
  distorted.input.stages = {gravity_stage()};
  EXPECT_LT(residual_at_start(distorted), 1e-12);
}

TEST(Refused, WhatNothingHolds) {
  Scene scene = bed();
  scene.input.stages = {gravity_stage()};
  scene.input.supports = {support({"left", "right"}, "x")};
  expect_refused(scene, "support: nothing holds the ground along y");
  scene.input.supports = {support({"base"}, "y")};
  expect_refused(scene, "support: nothing holds the ground along x");
  scene.input.supports = {point_support({.name = "base_left", .at = {}}, "xy")};
  expect_refused(scene, "support: nothing keeps the ground from turning");
  scene.input.supports = {support({"base"}, "xy")};
  StageCase let_go = stage("let_go");
  let_go.releases = {{.boundary = "base"}};
  scene.input.stages = {gravity_stage(), let_go};
  expect_refused(scene, "stage[1]: nothing holds the ground along");
}

/// A piece that the excavation cuts off falls.
TEST(Refused, APieceThatNothingHolds) {
  Scene scene = scene_on(grid(4, 3, 4, 3, {"lower", "middle", "upper"}), 20e3);
  scene.input.supports = {support({"base"}, "xy")};
  StageCase dig = stage("dig");
  dig.excavations = {{.regions = {"middle"}}};
  scene.input.stages = {gravity_stage(), dig};
  expect_refused(scene, "stage[1]: nothing holds the piece of ground about (2, 2.5) m along");
  scene.input.supports.push_back(support({"top"}, "y"));
  scene.input.supports.push_back(point_support({.name = "top_left", .at = {}}, "x"));
  EXPECT_EQ(plan_stages(scene).size(), 2U);
}

TEST(Refused, TheLastGround) {
  Scene scene = bed();
  StageCase dig = stage("dig");
  dig.excavations = {{.regions = {"lower"}}, {.regions = {"upper"}}};
  scene.input.stages = {gravity_stage(), dig};
  expect_refused(scene, "stage[1].excavate[1].region: nothing of the ground is left");
}

TEST(Refused, WhatIsDugOutTwice) {
  Scene scene = bed();
  StageCase dig = stage("dig"), again = stage("again");
  dig.excavations = again.excavations = {{.regions = {"upper"}}};
  scene.input.stages = {dig, again};
  expect_refused(scene, "stage[1].excavate[0].region: upper has been dug out before");
  again.excavations = {{.regions = {"nowhere"}}};
  scene.input.stages = {again};
  expect_refused(scene, "stage[0].excavate[0].region: the mesh has no region nowhere");
}

/// A region that is dug out takes its supports with it; the rest must be held.
TEST(Refused, WhatASupportThatIsDugOutHeld) {
  Scene scene = bed();
  StageCase dig = stage("dig");
  dig.excavations = {{.regions = {"lower"}}};
  scene.input.stages = {dig};
  expect_refused(scene, "stage[0]: nothing holds the ground along y");
}

TEST(Refused, APressOnWhatIsHeldOrGone) {
  Scene scene = bed();
  StageCase press = stage("press");
  press.presses = {pressure_on("left", 1e4)};
  scene.input.stages = {press};
  expect_refused(scene, "stage[0].press[0].boundary: left is held along x: move or release it");
  press.presses = {traction_on("left", 0, 1e3)};
  scene.input.stages = {press};
  EXPECT_EQ(plan_stages(scene).size(), 1U);

  StageCase dig = stage("dig");
  dig.excavations = {{.regions = {"upper"}}};
  press.presses = {pressure_on("top", 1e4)};
  scene.input.stages = {dig, press};
  expect_refused(scene, "stage[1].press[0].boundary: all of top has been dug out");

  scene.mesh.nodes["inside"] = {0, 1};
  press.presses = {pressure_on("inside", 1e4)};
  scene.input.stages = {press};
  const std::string sentence =
      "stage[0].press[0].boundary: inside lies inside the ground: it may be held or moved, but "
      "not pressed";
  expect_refused(scene, sentence);
  scene.mesh.edges["inside"] = {};
  expect_refused(scene, sentence);
}

TEST(Refused, AReleaseOfWhatNothingHolds) {
  Scene scene = bed();
  StageCase let_go = stage("let_go");
  let_go.releases = {{.boundary = "top"}};
  scene.input.stages = {let_go};
  expect_refused(scene, "stage[0].release[0].boundary: nothing holds top");
}

TEST(Refused, GroundAtRestWhereTheWeightIsTiltedOrGroundWasDugOut) {
  Scene scene = bed();
  scene.input.supports = {support({"base"}, "xy"), support({"left"}, "x")};
  StageCase settle = gravity_stage(), tilt = stage("tilt", 2);
  settle.presses = {at_rest_on("right")};
  tilt.tilt = 0.1;
  scene.input.stages = {settle, tilt};
  expect_refused(scene, "stage[1].tilt: right is pressed by ground at rest, which is level");
  settle.tilt = 0.1;
  scene.input.stages = {settle};
  expect_refused(scene, "stage[0].tilt: right is pressed by ground at rest, which is level");
  StageCase dig = stage("dig");
  dig.excavations = {{.regions = {"upper"}}};
  settle.tilt = {};
  scene.input.stages = {dig, settle};
  expect_refused(scene, "stage[1].press[0].at_rest: ground was dug out before");
}

TEST(Refused, GroundAtRestUnderASlope) {
  Scene scene = bed();
  scene.input.supports = {support({"base"}, "xy"), support({"left"}, "x")};
  EXPECT_EQ(level_layers(scene, {"right"}, "key").size(), 2U);
  Scene slope = scene;
  for (auto x : slope.mesh.coordinates.colwise()) x.y() *= 1 + 0.1 * x.x();
  expect_throws<std::runtime_error>([&] { static_cast<void>(level_layers(slope, {"right"}, "key")); },
                                    "key: needs a level surface and level layers: top spans y = ");
  // Two openings: the floor of the one is no surface for the other.
  const std::vector<int> left_half = [&] {
    std::vector<int> side;
    for (int e = 0; e < scene.mesh.n_elements(); ++e)
      side.push_back(scene.mesh.coordinates(0, scene.mesh.elements[e][0]) < 1.9 ? 0 : 1);
    return side;
  }();
  Scene aside = scene;
  fem::set_layers(aside.mesh, {"lower", "upper"}, left_half);
  expect_throws<std::runtime_error>([&] { static_cast<void>(level_layers(aside, {"right"}, "key")); },
                                    "key: needs a level surface and level layers: region");
}

TEST(Refused, MotionsThatAreTooWide) {
  Scene scene = bed();
  StageCase fall = stage("fall", 2);
  fall.moves = {move_by("base", {}, -0.8)};
  scene.input.stages = {fall};
  const StagePlan plan = plan_stages(scene).front();
  expect_throws<std::runtime_error>([&] { check_steps(scene, plan, 0); },
                                    "stage[0].steps: base moves by 0.4 of an element's edge a step: more steps");
}

TEST(Refused, APointThatIsNoNode) {
  Scene scene = bed();
  scene.input.supports.push_back(point_support({.name = "", .at = {0.3, 0.3}}, "x"));
  scene.input.stages = {gravity_stage()};
  expect_refused(scene, "support[2].point: no node of the mesh lies at (0.3, 0.3) m");
}

TEST(Refused, MotionsOfWhatHasBeenDugOutAndMotionsThatWouldBeLost) {
  Scene scene = bed();
  StageCase dig = stage("dig"), lift = stage("lift");
  dig.excavations = {{.regions = {"upper"}}};
  lift.moves = {move_by("top", {}, 0.01)};
  scene.input.stages = {dig, lift};
  expect_refused(scene, "stage[1].move[0].boundary: all of top has been dug out");
  lift.moves = {move_by("", {}, 0.01)};
  lift.moves[0].point.name = "top_left";
  scene.input.stages[1] = lift;
  expect_refused(scene, "stage[1].move[0].point: the ground about the point has been dug out");
  lift.moves = {move_by("base", {}, 0.01), move_by("base", 0.0, -0.01)};
  scene.input.stages[1] = lift;
  expect_refused(scene, "stage[1].move[1]: moves along y what move[0] of this stage moves already");
  lift.moves = {move_by("base", {}, 0.01), move_by("base", 0.01, {})};
  scene.input.stages[1] = lift;
  EXPECT_EQ(plan_stages(scene).size(), 2U);
}

/// A boundary that shrinks must be closed, or its ends must stay on what holds them.
TEST(Area, EndsOnSupportsOrIsRefused) {
  const auto ring = [](int quarters) {
    Scene scene = scene_on(fem::make_ring({.radius = 1, .outer = 4, .columns = 4, .rows = 3, .quarters = quarters}), 0);
    scene.input.supports = {support({"far"}, "xy")};
    if (quarters == 1) scene.input.supports.push_back(support({"y0"}, "y"));
    return scene;
  };
  StageCase shrink = stage("shrink", 4);
  shrink.moves = {affine("cavity", 0, -0.1, {0, 0})};
  Scene quarter = ring(1);
  quarter.input.stages = {shrink};
  expect_refused(quarter, "stage[0].move[0].area: cavity is neither closed nor ends on supports through its point");
  quarter.input.supports.push_back(support({"x0"}, "x"));
  EXPECT_EQ(plan_stages(quarter).size(), 1U);
  // What held the boundary itself until now is no support at its ends.
  quarter.input.supports.push_back(support({"cavity"}, "xy"));
  EXPECT_EQ(plan_stages(quarter).size(), 1U);
  shrink.moves = {affine("cavity", 0, -0.1, {0, 0.3})};
  quarter.input.stages = {shrink};
  expect_refused(quarter, "stage[0].move[0].area: cavity is neither closed nor ends on supports through its point");

  Scene whole = ring(4);
  whole.input.stages = {shrink};
  EXPECT_EQ(plan_stages(whole).size(), 1U);
}

/// The area of a quarter or a half opening is counted about the motion's centre, wherever the mesh lies.
TEST(Area, IsLostAsAskedWhereverTheMeshLies) {
  for (const int quarters : {1, 2, 4}) {
    Scene scene = scene_on(fem::make_ring({.radius = 1, .outer = 4, .columns = 8, .rows = 3, .quarters = quarters}), 0);
    scene.mesh.coordinates.colwise() += fem::Point(7, -3);
    fem::LinearElastic material(static_cast<std::size_t>(scene.mesh.n_points()), {});
    Ground ground{scene.mesh, material, {}, {}};
    begin_stage(ground);
    for (const int node : scene.mesh.node_set("cavity")) {
      ground.state.displacement.segment<2>(2 * node) = fem::affine_displacement(scene.mesh.coordinates.col(node),
                                                                                {7, -3}, 0, -0.1);
    }
    EXPECT_NEAR(lost_area(ground, "cavity", fem::Point(7, -3)), 0.1, 1e-12) << quarters;
  }
}

}  // namespace
}  // namespace voussoir::host
