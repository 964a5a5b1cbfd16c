// Scenes of linear elastic ground against closed forms: a ring by release, by excavation and by pressure, columns of
// layers, a tilted bed, lifts, stages that move the mesh one after the other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fem/linear_elastic.hpp"
#include "host/scene/run_stages.hpp"
#include "tests/scene_support.hpp"

namespace voussoir::host {
namespace {

constexpr double p0 = 1e3;     ///< [Pa]
constexpr double young = 5e7;  ///< [Pa]
constexpr double poisson = 0.3;
constexpr double shear = young / (2 * (1 + poisson));
constexpr double stiff = 5e9;  ///< strains of 1e-5, so that the ground stays nearly as drawn [Pa]
constexpr double degree = std::numbers::pi / 180;

/// Inward displacement at the radius a where the pressure there falls by `fall`; the far edge at b is fixed, or free
/// under its own pressure.
double lame(double a, double b, double fall, bool fixed) {
  constexpr double k = 1 - 2 * poisson;
  if (fixed) return fall * a * k / (2 * shear) * (b * b - a * a) / (k * b * b + a * a);
  return fall * a / (2 * shear) * (b * b + k * a * a) / (b * b - a * a);
}

constexpr double radius = 1, outer = 5;

/// A quarter of a ring; `core` adds the ground inside the radius 1 as a region, down to a small hole.
Scene quarter(bool core, const std::vector<SupportCase>& more) {
  fem::Mesh mesh = core ? fem::make_ring({.radius = 0.2, .outer = outer, .columns = 8, .rows = 24, .ratio = 1})
                        : fem::make_ring({.radius = radius, .outer = outer, .columns = 8, .rows = 20, .ratio = 1});
  if (core) {
    std::vector<int> region;
    for (const fem::ElementNodes& element : mesh.elements) {
      double most = 0;
      for (const int node : element) most = std::max(most, mesh.coordinates.col(node).norm());
      region.push_back(most < radius + 1e-6 ? 0 : 1);
    }
    fem::set_layers(mesh, {"core", "ring"}, region);
  }
  Scene scene = scene_on(std::move(mesh), 0, p0);
  scene.input.supports = {support({"x0"}, "x"), support({"y0"}, "y")};
  scene.input.supports.insert(scene.input.supports.end(), more.begin(), more.end());
  return scene;
}

/// The mean inward displacement of all nodes at the radius 1.
double inward(const Scene& scene, const Eigen::VectorXd& displacement) {
  double sum = 0;
  int count = 0;
  for (int node = 0; node < scene.mesh.n_nodes(); ++node) {
    const fem::Point x = scene.mesh.coordinates.col(node);
    if (std::abs(x.norm() - radius) > 1e-6) continue;
    sum -= displacement.segment<2>(2 * node).dot(x) / x.norm();
    ++count;
  }
  return sum / count;
}

double largest(const Eigen::VectorXd& v) { return v.cwiseAbs().maxCoeff(); }

TEST(Lame, ByReleaseAtOnceAndInParts) {
  for (const bool fixed : {true, false}) {
    Scene scene = quarter(false, {support({"cavity"}, "xy")});
    if (fixed) scene.input.supports.push_back(support({"far"}, "xy"));
    StageCase all = stage("all", 2);
    all.releases = {{.boundary = "cavity"}};
    scene.input.stages = {all};
    const Eigen::VectorXd at_once = ElasticRun{.scene = scene}.run("lame").back().displacement;
    const double exact = lame(radius, outer, p0, fixed);
    EXPECT_NEAR(inward(scene, at_once), exact, 1e-3 * exact) << fixed;

    StageCase part = stage("part", 2), rest = stage("rest", 2);
    part.releases = {{.boundary = "cavity", .share = 0.4}};
    rest.releases = {{.boundary = "cavity"}};
    scene.input.stages = {part, stage("wait"), rest};
    for (StageCase& one : scene.input.stages) one.geometry = LossGeometry::updated_lagrangian;
    const std::vector<StageEnd> parts = ElasticRun{.scene = scene}.run("lame_parts");
    EXPECT_NEAR(inward(scene, parts[0].displacement), 0.4 * exact, 1e-3 * exact);
    EXPECT_NEAR(inward(scene, parts[1].displacement), 0.4 * exact, 1e-3 * exact);
    EXPECT_NEAR(inward(scene, parts[2].displacement), inward(scene, at_once), 1e-4 * exact);
  }
}

/// A press after a release in part begins with the rest of the forces and takes their place.
TEST(Lame, ByPressureAlsoAfterAReleaseInPart) {
  Scene scene = quarter(false, {support({"far"}, "xy")});
  StageCase press = stage("press", 2);
  press.presses = {pressure_on("cavity", 0.3 * p0)};
  scene.input.stages = {press};
  const double exact = lame(radius, outer, 0.7 * p0, true);
  EXPECT_NEAR(inward(scene, ElasticRun{.scene = scene}.run("press").back().displacement), exact, 1e-3 * exact);

  scene.input.supports.push_back(support({"cavity"}, "xy"));
  StageCase part = stage("part", 2);
  part.releases = {{.boundary = "cavity", .share = 0.4}};
  scene.input.stages = {part, press};
  for (StageCase& one : scene.input.stages) one.geometry = LossGeometry::updated_lagrangian;
  EXPECT_NEAR(inward(scene, ElasticRun{.scene = scene}.run("press_rest").back().displacement), exact, 1e-3 * exact);
}

/// What holds a boundary again bears all of it, and a second release takes all of that off.
TEST(Lame, ReleasedInPartThenHeldThenReleased) {
  Scene scene = quarter(false, {support({"far"}, "xy"), support({"cavity"}, "xy")});
  StageCase part = stage("part"), hold = stage("hold"), all = stage("all");
  part.releases = {{.boundary = "cavity", .share = 0.4}};
  hold.moves = {move_by("cavity", 0.0, 0.0)};
  all.releases = {{.boundary = "cavity"}};
  scene.input.stages = {part, hold, all};
  for (StageCase& one : scene.input.stages) one.geometry = LossGeometry::updated_lagrangian;
  const std::vector<StageEnd> ends = ElasticRun{.scene = scene}.run("held_again");
  const double exact = lame(radius, outer, p0, true);
  EXPECT_NEAR(inward(scene, ends[2].displacement), exact, 1e-3 * exact);
  const Eigen::VectorXd full = fem::pressure_force(scene.mesh.coordinates, scene.mesh.edge_set("cavity"), p0);
  const std::vector<int>& nodes = scene.mesh.node_set("cavity");
  for (std::size_t k = 1; k + 1 < nodes.size(); ++k)
    EXPECT_LT((ends[1].reactions - 0.6 * full).segment<2>(2 * nodes[k]).norm(), 1e-3 * p0);
}

TEST(Lame, ByExcavationOfTheCore) {
  Scene scene = quarter(true, {support({"far"}, "xy")});
  StageCase dig = stage("dig", 2);
  dig.excavations = {{.regions = {"core"}}};
  scene.input.stages = {dig};
  const double exact = lame(radius, outer, p0, true);
  const StageEnd end = ElasticRun{.scene = scene}.run("dig").back();
  EXPECT_NEAR(inward(scene, end.displacement), exact, 2e-3 * exact);
  for (int e = 0; e < scene.mesh.n_elements(); ++e) {
    const bool is_dug = scene.mesh.region[e] == 0;
    EXPECT_EQ(end.stress[4 * e] == fem::Stress(fem::Stress::Zero()), is_dug) << e;
  }
}

/// Stresses of two layers and the force at their base.
TEST(Column, OfTwoLayersIsExact) {
  Scene scene = scene_on(grid(2, 6, 2, 6, {"lower", "upper"}), 20e3, p0);
  scene.input.regions[1].unit_weight = 15e3;
  scene.input.supports = {support({"base"}, "xy"), support({"left", "right"}, "x")};
  scene.input.stages = {gravity_stage()};
  const StageEnd end = ElasticRun{.scene = scene, .young = stiff}.run("column").back();
  const fem::GaussPoints points = fem::gauss_points(scene.mesh, scene.mesh.coordinates);
  for (int p = 0; p < scene.mesh.n_points(); ++p) {
    const double y = points.positions(1, p);
    const double weight = y > 3 ? 15e3 * (6 - y) : 15e3 * 3 + 20e3 * (3 - y);
    EXPECT_NEAR(end.stress[p][1], -(p0 + weight), 1e-4 * (p0 + weight)) << y;
    EXPECT_NEAR(end.stress[p][0], -(p0 + poisson / (1 - poisson) * weight), 1e-4 * (p0 + weight)) << y;
  }
  double base = 0;
  for (const int node : scene.mesh.node_set("base")) base += end.reactions[2 * node + 1];
  EXPECT_NEAR(base, 2 * (p0 + 15e3 * 3 + 20e3 * 3), 1e-6 * base);
}

/// The middle of a long bed on a rough base: the shear at depth z is gamma z sin(tilt).
TEST(Tilt, OfALongBed) {
  Scene scene = scene_on(grid(30, 2, 30, 4, {"ground"}), 20e3, p0);
  scene.input.supports = {support({"base"}, "xy")};
  StageCase tilt = stage("tilt", 2);
  tilt.tilt = 10 * degree;
  scene.input.stages = {gravity_stage(), tilt};
  const std::vector<StageEnd> ends = ElasticRun{.scene = scene, .young = stiff}.run("tilt");
  const fem::GaussPoints points = fem::gauss_points(scene.mesh, scene.mesh.coordinates);
  int seen = 0;
  for (int p = 0; p < scene.mesh.n_points(); ++p) {
    if (std::abs(points.positions(0, p) - 15) > 1) continue;
    const double weight = 20e3 * (2 - points.positions(1, p));
    EXPECT_NEAR(ends[0].stress[p][2], 0, 2e-2 * (p0 + weight));
    EXPECT_NEAR(std::abs(ends[1].stress[p][2]), weight * std::sin(10 * degree), 1e-2 * (p0 + weight));
    EXPECT_NEAR(ends[1].stress[p][1], -(p0 + weight * std::cos(10 * degree)), 1e-2 * (p0 + weight));
    ++seen;
  }
  EXPECT_GT(seen, 10);
  double base = 0;
  for (const int node : scene.mesh.node_set("base")) base += ends[1].reactions[2 * node];
  EXPECT_NEAR(base, -30 * 2 * 20e3 * std::sin(10 * degree), 1e-3 * 30 * 2 * 20e3);  // gravity pulls towards +x
}

/// A trench of three lifts beside a held axis; all on a fixed mesh, so that strains are nearly infinitesimal.
Scene trench() {
  fem::GridOptions options;
  options.x = {{0, 2, 8}, {2, 5}};
  options.y = {{0, 3, 4, 5, 6}, {2, 1, 1, 1}};
  fem::Mesh mesh = fem::make_grid(options);
  std::vector<int> region;
  for (const fem::ElementNodes& element : mesh.elements) {
    const fem::Point centre = 0.5 * (mesh.coordinates.col(element[0]) + mesh.coordinates.col(element[2]));
    region.push_back(centre.x() > 2 || centre.y() < 3 ? 0 : 1 + static_cast<int>(std::floor(centre.y() - 3)));
  }
  fem::set_layers(mesh, {"ground", "third", "second", "first"}, region);
  Scene scene = scene_on(std::move(mesh), 20e3, p0);
  scene.input.supports = {support({"base"}, "xy"), support({"left", "right"}, "x")};
  return scene;
}

StageCase dig(const std::string& name, std::vector<std::string> regions) {
  StageCase one = stage(name, 2);
  for (std::string& region : regions) one.excavations.push_back({.regions = {std::move(region)}});
  return one;
}

TEST(Excavation, InThreeLiftsIsTheSameAsAtOnce) {
  Scene scene = trench();
  const auto run = [&](const std::vector<StageCase>& stages) {
    scene.input.stages = {gravity_stage()};
    scene.input.stages.insert(scene.input.stages.end(), stages.begin(), stages.end());
    return ElasticRun{.scene = scene, .young = stiff}.run("trench");
  };
  const std::vector<StageEnd> once = run({dig("all", {"first", "second", "third"})});
  const std::vector<StageEnd> lifts = run({dig("one", {"first"}), dig("two", {"second"}), dig("three", {"third"})});
  const auto& a = once.back().stress;
  const auto& b = lifts.back().stress;
  double difference = 0, size = 0;
  for (std::size_t p = 0; p < a.size(); ++p) {
    difference = std::max(difference, (a[p] - b[p]).cwiseAbs().maxCoeff());
    size = std::max(size, a[p].cwiseAbs().maxCoeff());
  }
  EXPECT_LT(difference, 1e-4 * size);
  // The weight that is left and p0 on what is left of the top, as the base bears them.
  double base = 0;
  for (const int node : scene.mesh.node_set("base")) base += lifts.back().reactions[2 * node + 1];
  EXPECT_NEAR(base, 20e3 * (8 * 6 - 2 * 3) + p0 * 6, 1e-6 * base);
}

/// All reactions and all loads together vanish at the end of each stage.
TEST(Equilibrium, OfReactionsAndLoads) {
  Scene scene = trench();
  StageCase push = stage("push", 2), let_go = stage("let_go", 2), tilt = stage("tilt", 2);
  push.moves = {move_by("right", -0.01, {})};
  let_go.releases = {{.boundary = "right", .share = 0.5}};
  let_go.presses = {pressure_on("top", 3e3)};
  tilt.tilt = 3 * degree;
  StageCase lift = dig("lift", {"first"});
  scene.input.stages = {gravity_stage(), push, let_go, lift, tilt};
  for (std::size_t k = 1; k < 5; ++k) scene.input.stages[k].geometry = LossGeometry::updated_lagrangian;
  for (const StageEnd& end : ElasticRun{.scene = scene}.run("equilibrium")) {
    EXPECT_LT(total(end.reactions + end.external).norm(), 1e-7 * total(end.external).norm());
    EXPECT_TRUE(end.displacement.allFinite());
  }
}

/// The second of two stages begins on the mesh that the first has left: totals add up, and motions count from there.
TEST(Stages, ThatMoveTheMeshGoOnFromOneAnother) {
  Scene scene = scene_on(grid(2, 1, 2, 1, {"ground"}), 0, p0);
  scene.input.supports = {support({"base"}, "xy"), support({"left", "right"}, "x")};
  StageCase down = stage("down", 2), more = stage("more", 2);
  down.geometry = more.geometry = LossGeometry::updated_lagrangian;
  down.moves = {move_by("top", {}, -0.01)};
  more.moves = {move_by("top", {}, -0.02)};
  scene.input.stages = {down, more};
  const std::vector<StageEnd> ends = ElasticRun{.scene = scene}.run("stages");
  const int top = scene.mesh.point("top_left");
  EXPECT_NEAR(ends[0].displacement[2 * top + 1], -0.01, 1e-15);
  EXPECT_NEAR(ends[1].displacement[2 * top + 1], -0.03, 1e-15);
  EXPECT_NEAR(ends[1].coordinates(1, top), 0.97, 1e-15);
  // The logarithmic law takes the same end in one stage.
  more.moves = {move_by("top", {}, -0.03)};
  scene.input.stages = {more};
  const StageEnd once = ElasticRun{.scene = scene}.run("stages").back();
  EXPECT_NEAR(once.stress[0][1], ends[1].stress[0][1], 1e-9 * std::abs(once.stress[0][1]));
}

/// A wall turns about its toe and back again. The toe has moved before, and is the centre where it lies now.
TEST(Stages, AWallThatTurnsAndTurnsBack) {
  Scene scene = scene_on(grid(4, 2, 4, 2, {"ground"}), 0, p0);
  scene.input.supports = {support({"base"}, "y"), support({"right"}, "x"), support({"left"}, "x")};
  StageCase push = stage("push", 2), turn = stage("turn", 10), back = stage("back", 10);
  push.moves = {move_by("left", -0.05, {})};
  MoveCase rotation = affine("left", 5 * degree, 0, {0, 0});
  rotation.area.reset();
  rotation.about.name = "base_left";
  turn.moves = {rotation};
  *rotation.rotation *= -1;
  back.moves = {rotation};
  scene.input.stages = {push, turn, back};
  for (StageCase& one : scene.input.stages) one.geometry = LossGeometry::updated_lagrangian;
  const std::vector<StageEnd> ends = ElasticRun{.scene = scene}.run("wall");
  const int toe = scene.mesh.point("base_left"), head = scene.mesh.point("top_left");
  EXPECT_NEAR(ends[1].displacement[2 * toe], -0.05, 1e-14);
  const double height = ends[0].coordinates(1, head);
  EXPECT_NEAR(ends[1].coordinates(0, head), -0.05 - height * std::sin(5 * degree), 1e-12);
  EXPECT_NEAR(ends[1].coordinates(1, head), height * std::cos(5 * degree), 1e-12);
  for (const int node : scene.mesh.node_set("left"))
    EXPECT_LT((ends[2].displacement - ends[0].displacement).segment<2>(2 * node).norm(), 1e-13);
  EXPECT_LT(largest(ends[2].displacement - ends[0].displacement), 1e-4);
}

/// The work of the owned reaction along the motion is the energy that the ground stores.
TEST(Reactions, AreConjugateToTheMotion) {
  fem::GridOptions options;
  options.x = {{0, 2, 3, 5}, {4, 3, 4}};
  options.y = {{0, 2}, {4}};
  options.base = {"floor", "door", "floor"};
  options.layers = {"ground"};
  Scene scene = scene_on(fem::make_grid(options), 0, p0);
  scene.input.supports = {support({"floor", "door"}, "xy"), support({"left", "right"}, "x")};
  StageCase lower = stage("lower");
  const double down = 1e-5;
  lower.moves = {move_by("door", {}, -down)};
  scene.input.stages = {lower};
  const StageEnd end = ElasticRun{.scene = scene, .tolerance = 1e-9}.run("door").back();
  const StagePlan plan = plan_stages(scene).front();
  double door = 0;
  for (const auto& [dof, owner] : plan.owners) {
    if (plan.holders[owner].name == "door" && dof % 2 == 1) door += end.reactions[dof];
  }
  // Energy from the strains of the displacement against the change of the reaction, which began with p0 on the door.
  const fem::GaussPoints points = fem::gauss_points(scene.mesh, scene.mesh.coordinates);
  std::vector<fem::Gradient> gradients;
  fem::displacement_gradients(scene.mesh, points, end.displacement, gradients);
  const fem::Tangent d = fem::plane_strain_stiffness(young, poisson);
  double energy = 0;
  for (int p = 0; p < scene.mesh.n_points(); ++p) {
    const Eigen::Vector3d e(gradients[p](0, 0), gradients[p](1, 1), gradients[p](0, 1) + gradients[p](1, 0));
    energy += 0.5 * points.volumes[p] * e.dot(d * e);
  }
  double before = 0;  // of p0 on the nodes that the door owns
  const Eigen::VectorXd full = fem::pressure_force(scene.mesh.coordinates, scene.mesh.edge_set("door"), p0) +
                               fem::pressure_force(scene.mesh.coordinates, scene.mesh.edge_set("floor"), p0);
  for (const auto& [dof, owner] : plan.owners) {
    if (plan.holders[owner].name == "door" && dof % 2 == 1) before += full[dof];
  }
  EXPECT_NEAR(0.5 * (door - before) * -down, energy, 1e-3 * energy);
}

TEST(Mesh, OfOneElement) {
  Scene scene = scene_on(grid(1, 1, 1, 1, {"ground"}), 20e3, p0);
  scene.input.supports = {support({"base"}, "xy"), support({"left", "right"}, "x")};
  scene.input.stages = {gravity_stage()};
  const StageEnd end = ElasticRun{.scene = scene, .young = stiff}.run("one").back();
  EXPECT_NEAR(total(end.reactions).y(), p0 + 20e3, 1e-6 * 20e3);
}

}  // namespace
}  // namespace voussoir::host
