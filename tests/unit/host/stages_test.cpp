// What the stages check and remember, on linear elastic ground: the state at rest, the opening's reactions,
// checkpoints.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "fem/linear_elastic.hpp"
#include "host/kinds/column.hpp"
#include "host/kinds/geostatic_check.hpp"
#include "host/kinds/opening_check.hpp"
#include "host/kinds/tunnel_mesh.hpp"
#include "host/kinds/tunnel_scene.hpp"
#include "host/record/provenance.hpp"
#include "host/scene/scene_loads.hpp"
#include "host/stages/ground_checkpoint.hpp"

namespace voussoir::host {
namespace {

Case small_tunnel() {
  Case input;
  input.material = MaterialKind::linear_elastic;
  input.ground.mesh_size_opening = 1.2;
  input.ground.mesh_size_far = 8.0;
  input.name = "small_tunnel";
  input.fingerprint = "host_stages_test";
  return input;
}

/// A K0 that is the same at all stresses.
K0Table constant_k0(double ratio) { return {{1.0, 1.0e7}, {ratio, ratio}}; }

/// A tunnel in ground at rest with K0 = 0.5 everywhere.
struct ElasticGround {
  Case input = small_tunnel();
  fem::Mesh mesh = tunnel_mesh(input.ground);
  fem::LinearElastic material{static_cast<std::size_t>(mesh.n_points()), {.young = 5e7, .poisson = 0.3}};
  Ground ground{mesh, material, {}, {}};

  ElasticGround() {
    material.set_stress(at_rest());
    begin_stage(ground);
  }
  [[nodiscard]] std::vector<fem::Stress> at_rest() const {
    const fem::GaussPoints points = fem::gauss_points(mesh, mesh.coordinates);
    std::vector<fem::Stress> stress;
    for (Eigen::Index p = 0; p < points.positions.cols(); ++p) {
      const double vertical = input.ground.unit_weight * (input.ground.height - points.positions(1, p)) + 1e3;
      stress.emplace_back(-0.5 * vertical, -vertical, 0.0);
    }
    return stress;
  }
};

TEST(Geostatic, StateAtRestPasses) {
  ElasticGround rest;
  const GeostaticCheck check = check_geostatic(rest.ground, rest.input.ground);
  EXPECT_LT(check.vertical_error, 1e-6);
  EXPECT_NEAR(check.k0_minimum, 0.5, 1e-12);
  EXPECT_NEAR(check.k0_maximum, 0.5, 1e-12);
  EXPECT_LT(check.deflection_max, 1e-12);
  EXPECT_EQ(check.rows.size(), 20U);
  EXPECT_LT(check.row_ratio, 1e-8);
  EXPECT_LT(check.row_scatter, 1e-6);
}

TEST(Geostatic, RowsTellErrorFromScatter) {
  ElasticGround rest;
  std::vector<fem::Stress> stress = rest.at_rest();
  for (std::size_t p = 0; p < stress.size(); ++p) stress[p][1] += p % 2 == 0 ? 3e3 : -1e3;  // 1 kPa less, +- 2 kPa
  rest.material.set_stress(stress);
  const GeostaticCheck check = check_geostatic(rest.ground, rest.input.ground);
  double error = 0, scatter = 0;
  for (const GeostaticRow& row : check.rows) {
    EXPECT_NEAR(row.depth, 35.0 * (0.5 + static_cast<double>(&row - check.rows.data())) / 20, 1e-9);
    error += row.error / 20;
    scatter += row.scatter / 20;
  }
  // Few points a row on this mesh: a row holds not quite as many even points as odd ones.
  EXPECT_NEAR(error, -1e3, 200);
  EXPECT_NEAR(scatter, 2e3, 200);
  EXPECT_GT(check.row_ratio, 0.5);
  EXPECT_LT(check.vertical_error, 3e3 + 1);
}

TEST(Geostatic, DeflectionCountsWhereTheStressIsLarge) {
  ElasticGround rest;
  std::vector<fem::Stress> stress = rest.at_rest();
  for (fem::Stress& s : stress) s[2] = s[1] > -100e3 ? 0.1 * s[1] : 0.01 * s[1];
  rest.material.set_stress(stress);
  const GeostaticCheck check = check_geostatic(rest.ground, rest.input.ground);
  EXPECT_NEAR(check.deflection_max, 0.5 * std::atan2(0.2, 0.5), 1e-12);
  EXPECT_NEAR(check.deflection_deep, 0.5 * std::atan2(0.02, 0.5), 1e-12);
}

TEST(Geostatic, FaultsAreSeen) {
  ElasticGround rest;
  std::vector<fem::Stress> stress = rest.at_rest();
  for (fem::Stress& s : stress) s[1] *= 1.1;
  rest.material.set_stress(stress);
  EXPECT_GT(check_geostatic(rest.ground, rest.input.ground).vertical_ratio, 1.5);
  stress = rest.at_rest();
  for (fem::Stress& s : stress) s[2] = 0.1 * s[1];
  rest.material.set_stress(stress);
  EXPECT_NEAR(check_geostatic(rest.ground, rest.input.ground).deflection_max, 0.5 * std::atan2(0.2, 0.5), 1e-12);
}

/// The opening of the ground at rest, which is fixed after tractions with this K0 have held it.
struct FixedOpening {
  ElasticGround rest;
  Scene scene = tunnel_scene(rest.input, rest.mesh);
  std::vector<StagePlan> plans = plan_stages(scene);
  Eigen::VectorXd reactions = SceneLoads(scene, plans[1], rest.ground, nullptr).reactions(0, {});

  [[nodiscard]] OpeningCheck check(double ratio) const {
    const GroundAtRest at_rest{
        .layers = {{.bottom = 0, .top = rest.input.ground.height, .unit_weight = rest.input.ground.unit_weight}},
        .k0 = {constant_k0(ratio)},
        .pressure = rest.input.ground.surcharge};
    const Eigen::VectorXd tractions = at_rest.force(rest.mesh.coordinates, rest.mesh.edge_set("opening"), 1.0);
    return check_opening(rest.mesh, plans[0], reactions, tractions);
  }
};

TEST(Opening, ReactionsEqualTheTractionsOfElasticGround) {
  const FixedOpening opening;
  // Curved edges and a stress linear in depth: what is left is the quadrature's.
  EXPECT_LT(opening.check(0.5).relative, 1e-3);
  EXPECT_GT(opening.check(0.6).relative, 0.02);
}

TEST(Opening, ReactionsCarryTheGroundBeside) {
  const FixedOpening fixed;
  const ElasticGround& rest = fixed.rest;
  double base = 0;
  for (const int node : rest.mesh.node_set("base")) base += fixed.reactions[2 * node + 1];
  double opening = 0;
  for (const int node : rest.mesh.node_set("opening")) opening += fixed.reactions[2 * node + 1];
  const GroundCase& g = rest.input.ground;
  const double soil = g.width * g.height - 0.125 * std::numbers::pi * g.diameter * g.diameter;
  EXPECT_NEAR(base + opening, soil * g.unit_weight + g.width * g.surcharge, 1e-3 * base);
  EXPECT_GT(base, 0);
}

/// Different numbers in all members of the ground's state. The binding names them all: a new member does not compile
/// here until this function and the comparison below know it.
void scramble(Ground& ground) {
  auto& [mesh, material, state, strain, earlier] = ground;
  auto& [displacement, coordinates, deformation, initial_tangent, tangent, last_increment, last_step, start, parameter,
         step_limit, relaxation_factor] = state;
  displacement = Eigen::VectorXd::Random(mesh.n_dofs());
  coordinates += 0.01 * fem::Coordinates::Random(2, mesh.n_nodes());
  for (fem::Gradient& h : deformation) h = fem::Gradient::Random();
  for (fem::Tangent& d : initial_tangent) d = fem::Tangent::Random();
  for (fem::Tangent& d : tangent) d = fem::Tangent::Random();
  last_increment = Eigen::VectorXd::Random(mesh.n_dofs());
  last_step = 0.3;
  start = 0.1;
  parameter = 0.7;
  step_limit = 0.01;
  relaxation_factor = 1.75;
  for (fem::PlaneTensor& e : strain) e = fem::PlaneTensor::Random();
  earlier.displacement = Eigen::VectorXd::Random(mesh.n_dofs());
  earlier.strain.assign(strain.size(), fem::PlaneTensor::Random());
  earlier.coordinates = coordinates + fem::Coordinates::Random(2, mesh.n_nodes());
}

/// Names of the members in which two grounds differ.
std::set<std::string> differences(const Ground& one, const Ground& other) {
  const auto& [mesh_a, material_a, a, strain_a, earlier_a] = one;
  const auto& [mesh_b, material_b, b, strain_b, earlier_b] = other;
  std::set<std::string> found;
  const auto compare = [&](const char* name, bool same) {
    if (!same) found.insert(name);
  };
  compare("displacement", a.displacement == b.displacement);
  compare("coordinates", a.coordinates == b.coordinates);
  compare("deformation", a.deformation == b.deformation);
  compare("initial_tangent", a.initial_tangent == b.initial_tangent);
  compare("tangent", a.tangent == b.tangent);
  compare("last_increment", a.last_increment == b.last_increment);
  compare("last_step", a.last_step == b.last_step);
  compare("start", a.start == b.start);
  compare("parameter", a.parameter == b.parameter);
  compare("step_limit", a.step_limit == b.step_limit);
  compare("relaxation_factor", a.relaxation_factor == b.relaxation_factor);
  compare("strain", strain_a == strain_b);
  compare("earlier", earlier_a.displacement.size() == earlier_b.displacement.size() &&
                         earlier_a.displacement == earlier_b.displacement && earlier_a.strain == earlier_b.strain &&
                         earlier_a.coordinates == earlier_b.coordinates);
  compare("material", material_a.state() == material_b.state());
  return found;
}

TEST(GroundCheckpoint, GivesBackTheSameBits) {
  ElasticGround rest;
  scramble(rest.ground);
  io::Checkpoint checkpoint;
  save(rest.ground, checkpoint);

  ElasticGround other;
  other.material.set_stress(std::vector<fem::Stress>(other.material.size(), fem::Stress::Zero()));
  // Nothing is equal before the restoration, so that each member must come from the checkpoint.
  EXPECT_EQ(differences(rest.ground, other.ground).size(), 14U);
  restore(other.ground, checkpoint);
  EXPECT_EQ(differences(rest.ground, other.ground), std::set<std::string>{});
}

TEST(GroundCheckpoint, OfAnotherMeshIsRefused) {
  ElasticGround rest;
  io::Checkpoint checkpoint;
  save(rest.ground, checkpoint);
  Case input = small_tunnel();
  input.ground.mesh_size_opening = 0.7;
  const fem::Mesh mesh = tunnel_mesh(input.ground);
  fem::LinearElastic material(static_cast<std::size_t>(mesh.n_points()), {});
  Ground ground{mesh, material, {}, {}};
  EXPECT_THROW(restore(ground, checkpoint), std::runtime_error);
}

TEST(Column, MeasuresTheElasticK0) {
  const std::filesystem::path folder = "column";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  Case input = small_tunnel();
  input.elastic.poisson = 0.25;
  input.column.elements = 8;
  RunLog log(folder / "run.log", false);
  const RunOptions options{.folder = folder, .command = "test"};
  const ColumnResult column = measure_k0(column_setup(input), options, provenance_of(options, input, "column"), log);
  ASSERT_EQ(column.status, RunStatus::finished);
  const double k = 0.25 / 0.75;
  for (const double s : {2e3, 1e4, 1e5, 6e5})
    EXPECT_NEAR(column.k0.front().at(s), (1e3 + k * (s - 1e3)) / s, 5e-3) << s;
}

}  // namespace
}  // namespace voussoir::host
