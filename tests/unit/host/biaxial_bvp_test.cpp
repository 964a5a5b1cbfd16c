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
  const fem::Mesh mesh = fem::make_rectangle(1, 2, 2, 4);
  const fem::Constraints constraints = platen_constraints(mesh, -0.1);
  int horizontal = 0;
  for (const auto& [dof, value] : constraints) {
    horizontal += dof % 2 == 0;
    const double y = mesh.coordinates(1, dof / 2);
    EXPECT_TRUE(y == 0 || y == 2);
    EXPECT_EQ(value, y == 2 ? -0.1 : 0.0);
  }
  EXPECT_EQ(horizontal, 1);
  EXPECT_EQ(constraints.size(), 5U + 5U + 1U);
}

}  // namespace
}  // namespace voussoir::host
