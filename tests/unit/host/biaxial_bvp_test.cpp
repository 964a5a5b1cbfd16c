// The biaxial specimen on linear elastic ground, where the homogeneous solution is known.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "fem/linear_elastic.hpp"
#include "fem/mesh_rectangle.hpp"
#include "host/kinds/biaxial_bvp.hpp"
#include "io/result_file.hpp"

namespace voussoir::host {
namespace {

Case elastic_specimen() {
  Case input;
  input.kind = CaseKind::biaxial_bvp;
  input.material = MaterialKind::linear_elastic;
  input.biaxial_bvp.strain = 0.05;
  input.biaxial_bvp.strain_step = 5e-3;
  input.elastic.modulus = 2e7;
  input.newton.tolerance = 1e-9;
  input.newton.displacement_tolerance = 1e-9;
  input.name = "elastic_specimen";
  input.fingerprint = "host_biaxial_bvp_test";
  return input;
}

/// Sides at the pressure p and the plane-strain law in Hencky strains: eps_x = -nu/(1 - nu) eps_y.
TEST(BiaxialBvp, ElasticSpecimenFollowsTheClosedForm) {
  const Case input = elastic_specimen();
  RunOptions options;
  options.folder = "elastic_specimen";
  std::filesystem::remove_all(options.folder);
  ASSERT_EQ(run_biaxial_bvp(input, options), RunStatus::finished);
  const auto increments = io::read_increments(options.folder / "run.h5");
  ASSERT_EQ(increments.size(), 10U);
  const double nu = input.elastic.poisson;
  for (const io::IncrementInfo& info : increments) {
    const double axial = -std::log(1 - info.load_parameter);
    const double lateral = -nu / (1 - nu) * axial;
    const double rise = input.elastic.modulus / (1 - nu * nu) * axial;
    const auto value = [&](const char* name) { return info.extra.at(name).value; };
    EXPECT_NEAR(value("axial_strain"), axial, 1e-12);
    EXPECT_NEAR(value("volumetric_strain"), axial + lateral, 1e-13);
    EXPECT_NEAR(value("axial_stress"), 1e5 + rise, 1e-12 * rise);
    EXPECT_NEAR(value("q"), 0.5 * rise, 1e-12 * rise);
    EXPECT_NEAR(value("p"), 1e5 + 0.5 * rise, 1e-12 * rise);
  }
  const io::Tables tables = io::read_tables(options.folder / "run.h5");
  ASSERT_TRUE(tables.contains("gauss_histories"));
  for (const io::TableColumn& column : tables.at("gauss_histories")) {
    EXPECT_EQ(column.values.size(), 10U * 32U) << column.name;
    if (column.name != "stress_xx") continue;
    for (const double s : column.values) EXPECT_NEAR(s, -1e5, 1e-6);  // held by the follower pressure throughout
  }
}

TEST(BiaxialBvp, SpecimenIsHeldVerticallyAndByOneNode) {
  BiaxialBvpCase test;
  test.width = 1;
  test.height = 2;
  const Scene scene = specimen_scene(test);
  const StagePlan plan = plan_stages(scene).front();
  int horizontal = 0;
  for (const auto& [dof, owner] : plan.owners) {
    horizontal += dof % 2 == 0;
    const fem::Point x = scene.mesh.coordinates.col(dof / 2);
    EXPECT_TRUE(x.y() == 0 || x.y() == 2);
    const fem::Point moved = plan.holders[owner].displacement(x, 0.01, 0.06);
    EXPECT_EQ(moved.x(), 0);
    EXPECT_DOUBLE_EQ(moved.y(), x.y() == 2 ? -0.1 : 0.0);
  }
  EXPECT_EQ(horizontal, 1);
  EXPECT_EQ(plan.owners.size(), 5U + 5U + 1U);
}

}  // namespace
}  // namespace voussoir::host
