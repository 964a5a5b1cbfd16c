#include "host/case/mesh.hpp"

#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "host/case/engine.hpp"
#include "host/case/keys.hpp"
#include "host/case/result_fields.hpp"
#include "io/units.hpp"

namespace voussoir::host {

using io::Dimension;

ElasticCase read_elastic(const io::Table& table) {
  ElasticCase elastic;
  read_quantity(table, "modulus", Dimension::pressure, elastic.modulus, {.at_least = "1 kPa", .at_most = "100000 GPa"});
  read_quantity(table, "poisson", Dimension::none, elastic.poisson, {.at_least = "0", .at_most = "0.49"});
  return elastic;
}

GroundCase read_ground(const io::Table& table, bool with_tunnel) {
  GroundCase ground;
  read_quantity(table, "unit_weight", Dimension::unit_weight, ground.unit_weight,
                {.at_least = "1 N/m3", .at_most = "1 MN/m3"});
  read_quantity(table, "surcharge", Dimension::pressure, ground.surcharge, {.at_least = "100 Pa", .at_most = "10 MPa"});
  read_quantity(table, "height", Dimension::length, ground.height, {.at_least = "1 cm", .at_most = "10 km"});
  if (!with_tunnel) return ground;
  read_quantity(table, "width", Dimension::length, ground.width, {.at_least = "1.5 cm", .at_most = "10 km"});
  read_quantity(table, "diameter", Dimension::length, ground.diameter, {.at_least = "1 cm", .at_most = "1 km"});
  read_quantity(table, "cover_ratio", Dimension::none, ground.cover_ratio, {.at_least = "0.25", .at_most = "20"});
  read_quantity(table, "mesh_size_opening", Dimension::length, ground.mesh_size_opening,
                {.at_least = "1 mm", .at_most = "500 m"});
  read_quantity(table, "mesh_size_far", Dimension::length, ground.mesh_size_far,
                {.at_least = "1 mm", .at_most = "10 km"});
  if (ground.invert_height() < 0.5 * ground.diameter) {
    throw table.error("cover_ratio", "leaves less than D/2 of ground below the invert");
  }
  if (ground.width < 1.5 * ground.diameter) throw table.error("width", "is less than 1.5 tunnel diameters");
  if (ground.mesh_size_opening > 0.5 * ground.diameter) {
    throw table.error("mesh_size_opening", "is more than half the diameter");
  }
  if (ground.mesh_size_far < ground.mesh_size_opening) {
    throw table.error("mesh_size_far", "is smaller than mesh_size_opening");
  }
  const std::vector<std::filesystem::path> files = table.optional_paths("mesh_file");
  if (files.size() > 1) throw table.error("mesh_file", "names several files, but there is one mesh");
  if (!files.empty()) ground.mesh_file = files.front();
  return ground;
}

ColumnCase read_column(const io::Table& table) {
  ColumnCase column;
  read_integer(table, "elements", column.elements, {.at_least = 2, .at_most = 10000});
  read_quantity(table, "width", Dimension::length, column.width, {.at_least = "1 mm", .at_most = "1 km"});
  return column;
}

GravityCase read_gravity(const io::Table& table) {
  GravityCase gravity;
  read_quantity(table, "ratio", Dimension::none, gravity.ratio, {.at_least = "1.01", .at_most = "10"});
  read_quantity(table, "uniform_step", Dimension::none, gravity.uniform_step, {.at_least = "1e-4", .at_most = "1"});
  return gravity;
}

VolumeLossCase read_volume_loss(const io::Table& table) {
  VolumeLossCase loss;
  read_quantity(table, "total", Dimension::none, loss.total, {.at_least = "1e-6", .at_most = "0.9"});
  read_integer(table, "increments", loss.increments, {.at_least = 1, .at_most = 100000});
  loss.geometry = table.choice("geometry", {"updated_lagrangian", "fixed_mesh"}, "updated_lagrangian") == "fixed_mesh"
                      ? LossGeometry::fixed_mesh
                      : LossGeometry::updated_lagrangian;
  return loss;
}

BiaxialBvpCase read_biaxial_bvp(const io::Table& table) {
  BiaxialBvpCase test;
  read_quantity(table, "pressure", Dimension::pressure, test.pressure, {.at_least = "100 Pa", .at_most = "10 MPa"});
  read_quantity(table, "width", Dimension::length, test.width, {.at_least = "0.01 mm", .at_most = "1 km"});
  read_quantity(table, "height", Dimension::length, test.height, {.at_least = "0.01 mm", .at_most = "1 km"});
  read_integer(table, "columns", test.columns, {.at_least = 1, .at_most = 1000});
  read_integer(table, "rows", test.rows, {.at_least = 1, .at_most = 1000});
  read_quantity(table, "strain", Dimension::none, test.strain, {.at_least = "1e-6", .at_most = "0.5"});
  read_quantity(table, "strain_step", Dimension::none, test.strain_step, {.at_least = "1e-7", .at_most = "0.05"});
  if (test.strain > 100'000.5 * test.strain_step) throw table.error("strain_step", "makes more than 100000 increments");
  if (std::abs(test.increments() * test.strain_step - test.strain) > 1e-6 * test.strain) {
    throw table.error("strain_step", "must divide the strain into equal increments");
  }
  return test;
}

NewtonCase read_newton(const io::Table& table) {
  NewtonCase newton;
  read_quantity(table, "tolerance", Dimension::none, newton.tolerance, {.at_least = "1e-15", .at_most = "0.1"});
  read_quantity(table, "displacement_tolerance", Dimension::none, newton.displacement_tolerance,
                {.at_least = "1e-15", .at_most = "1"});
  read_integer(table, "maximum_iterations", newton.maximum_iterations, {.at_least = 1, .at_most = 10000});
  read_integer(table, "anderson_depth", newton.anderson_depth, {.at_least = 0, .at_most = 50});
  newton.tangent = read_tangent(table, newton.tangent);
  read_quantity(table, "tangent_strain", Dimension::none, newton.tangent_strain,
                {.at_least = "1e-8", .at_most = "1e-2"});
  read_quantity(table, "initial_tangent_fraction", Dimension::none, newton.initial_tangent_fraction,
                {.at_least = "0", .at_most = "10"});
  read_quantity(table, "relax_below", Dimension::none, newton.relax_below, {.at_least = "0", .at_most = "1"});
  read_integer(table, "relax_attempts", newton.relax_attempts, {.at_least = 1, .at_most = 10000});
  read_quantity(table, "relax_near", Dimension::none, newton.relax_near, {.at_least = "0", .at_most = "0.5"});
  read_integer(table, "relax_substeps", newton.relax_substeps, {.at_least = 0, .at_most = 10000});
  read_quantity(table, "smallest_cut", Dimension::none, newton.smallest_cut, {.at_least = "1e-6", .at_most = "1"});
  return newton;
}

OutputCase read_output(const io::Table& table) {
  OutputCase output;
  read_integer(table, "every", output.every, {.at_least = 1, .at_most = 1'000'000});
  read_integer(table, "checkpoint_every", output.checkpoint_every, {.at_least = 1, .at_most = 1'000'000});
  output.rves = table.integers("rves", {.at_least = 0, .at_most = 1'000'000'000}, std::vector<std::int64_t>{});
  const std::set<std::int64_t> different(output.rves.begin(), output.rves.end());
  if (different.size() != output.rves.size()) throw table.error("rves", "names a point twice");
  output.microstructure = read_microstructure(table);
  output.fields = table.texts("fields", std::vector<std::string>{});
  for (const std::string& name : output.fields) {
    if (find_result_field(name) == nullptr)
      throw table.error("fields", "\"" + name + "\" is not a field, see docs/reference/files.md");
  }
  return output;
}

kernels::MicrostructureRequest read_microstructure(const io::Table& table) {
  kernels::MicrostructureRequest request;
  for (const std::string& name : table.texts("microstructure", std::vector<std::string>{})) {
    if (!ask_for(name, request)) {
      throw table.error("microstructure", "\"" + name + "\" is neither fabric nor coordination nor strong_networks");
    }
  }
  return request;
}

}  // namespace voussoir::host
