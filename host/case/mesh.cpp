#include "host/case/mesh.hpp"

#include <cmath>
#include <filesystem>
#include <optional>
#include <stdexcept>
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
  read_quantity(table, {"modulus", "Young's modulus of the ground."}, Dimension::pressure, elastic.modulus,
                {.at_least = "1 kPa", .at_most = "100000 GPa"});
  read_quantity(table, {"poisson", "Poisson's ratio of the ground in plane strain."}, Dimension::none, elastic.poisson,
                {.at_least = "0", .at_most = "0.49"});
  return elastic;
}

GroundCase read_ground(const io::Table& table, bool with_tunnel) {
  GroundCase ground;
  read_quantity(table, {"unit_weight", "Unit weight of the ground, which the gravity stage puts on in increments."},
                Dimension::unit_weight, ground.unit_weight, {.at_least = "1 N/m3", .at_most = "1 MN/m3"});
  read_quantity(table,
                {"surcharge",
                 "Vertical pressure on the surface, from which the ground starts at rest. It must equal "
                 "`packing.pressure` and be at most half the weight of the ground."},
                Dimension::pressure, ground.surcharge, {.at_least = "100 Pa", .at_most = "10 MPa"});
  read_quantity(
      table,
      {"height",
       "Height of the ground from its base, which is fixed, to the surface; the column of a tunnel has it, too."},
      Dimension::length, ground.height, {.at_least = "1 cm", .at_most = "10 km"});
  if (!with_tunnel) return ground;
  read_quantity(table,
                {"width",
                 "Width of the half domain, from the axis of symmetry through the tunnel to the far side; at least 1.5 "
                 "tunnel diameters."},
                Dimension::length, ground.width, {.at_least = "1.5 cm", .at_most = "10 km"});
  read_quantity(table, {"diameter", "Diameter D of the tunnel."}, Dimension::length, ground.diameter,
                {.at_least = "1 cm", .at_most = "1 km"});
  read_quantity(table,
                {"cover_ratio",
                 "Cover-to-diameter ratio C/D: the ground above the crown over the tunnel's diameter. At least D/2 of "
                 "ground must remain below the invert."},
                Dimension::none, ground.cover_ratio, {.at_least = "0.25", .at_most = "20"});
  read_quantity(table,
                {"mesh_size_opening",
                 "Size of the elements at the opening, at most half the diameter. Smaller elements resolve the ground "
                 "near the tunnel better and cost more representative volume elements."},
                Dimension::length, ground.mesh_size_opening, {.at_least = "1 mm", .at_most = "500 m"});
  read_quantity(table, {"mesh_size_far", "Size of the elements at the far side and at the base."}, Dimension::length,
                ground.mesh_size_far, {.at_least = "1 mm", .at_most = "10 km"});
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
  const std::optional<std::filesystem::path> file = table.optional_path(
      {"mesh_file",
       "File of `voussoir mesh`, made for a ground of these sizes, which a run uses in place of making the mesh with "
       "Gmsh."});
  if (file) ground.mesh_file = *file;
  return ground;
}

ColumnCase read_column(const io::Table& table) {
  ColumnCase column;
  read_integer(table, {"elements", "Number of elements along the height of the column."}, column.elements,
               {.at_least = 2, .at_most = 10000});
  read_quantity(table, {"width", "Width of the column's single row of elements."}, Dimension::length, column.width,
                {.at_least = "1 mm", .at_most = "1 km"});
  return column;
}

GravityCase read_gravity(const io::Table& table) {
  GravityCase gravity;
  read_quantity(
      table,
      {"ratio",
       "Factor by which the vertical stress at the base grows from one increment of gravity to the next, until the "
       "increments are as large as `uniform_step`."},
      Dimension::none, gravity.ratio, {.at_least = "1.01", .at_most = "10"});
  read_quantity(table,
                {"uniform_step",
                 "Share of gravity that an increment has at most: the increments grow by `ratio` up to it and are "
                 "equal from there on."},
                Dimension::none, gravity.uniform_step, {.at_least = "1e-4", .at_most = "1"});
  return gravity;
}

VolumeLossCase read_volume_loss(const io::Table& table) {
  VolumeLossCase loss;
  read_quantity(
      table,
      {"total", "Volume loss at the end of the run: the area by which the opening has shrunk over its first area."},
      Dimension::none, loss.total, {.at_least = "1e-6", .at_most = "0.9"});
  read_integer(table, {"increments", "Number of equal increments in which the volume loss is reached."},
               loss.increments, {.at_least = 1, .at_most = 100000});
  loss.geometry = table.choice(
                      {"geometry",
                       "Whether the mesh moves with the ground while the volume is lost (`updated_lagrangian`), or "
                       "strains and equilibrium are those of the undeformed mesh (`fixed_mesh`)."},
                      {"updated_lagrangian", "fixed_mesh"}, "updated_lagrangian") == "fixed_mesh"
                      ? LossGeometry::fixed_mesh
                      : LossGeometry::updated_lagrangian;
  return loss;
}

BiaxialBvpCase read_biaxial_bvp(const io::Table& table) {
  BiaxialBvpCase test;
  read_quantity(table, {"pressure", "Pressure on the sides of the specimen, and isotropic pressure of its packings."},
                Dimension::pressure, test.pressure, {.at_least = "100 Pa", .at_most = "10 MPa"});
  read_quantity(table, {"width", "Width of the specimen."}, Dimension::length, test.width,
                {.at_least = "0.01 mm", .at_most = "1 km"});
  read_quantity(table, {"height", "Height of the specimen."}, Dimension::length, test.height,
                {.at_least = "0.01 mm", .at_most = "1 km"});
  read_integer(table, {"columns", "Number of elements across the specimen."}, test.columns,
               {.at_least = 1, .at_most = 1000});
  read_integer(table, {"rows", "Number of elements along the height of the specimen."}, test.rows,
               {.at_least = 1, .at_most = 1000});
  read_quantity(table, {"strain", "Displacement of the top at the end of the test, over the height."}, Dimension::none,
                test.strain, {.at_least = "1e-6", .at_most = "0.5"});
  read_quantity(table,
                {"strain_step",
                 "Displacement of the top in one increment, over the height. It must divide `strain` into equal "
                 "increments, 100000 at the most."},
                Dimension::none, test.strain_step, {.at_least = "1e-7", .at_most = "0.05"});
  if (test.strain > 100'000.5 * test.strain_step) throw table.error("strain_step", "makes more than 100000 increments");
  if (std::abs(test.increments() * test.strain_step - test.strain) > 1e-6 * test.strain) {
    throw table.error("strain_step", "must divide the strain into equal increments");
  }
  return test;
}

NewtonCase read_newton(const io::Table& table) {
  NewtonCase newton;
  read_quantity(
      table,
      {"tolerance",
       "Equilibrium counts as found where the residual force of the free nodes is at most this share of the "
       "external force or of the reactions of the supports, whichever is larger, beside a floor for the noise of "
       "the grains."},
      Dimension::none, newton.tolerance, {.at_least = "1e-15", .at_most = "0.1"});
  read_quantity(table,
                {"displacement_tolerance",
                 "Equilibrium counts as found where, besides, the last correction of the displacements is at most this "
                 "share of the increment's displacements."},
                Dimension::none, newton.displacement_tolerance, {.at_least = "1e-15", .at_most = "1"});
  read_integer(table,
               {"maximum_iterations",
                "Largest number of iterations of an increment that may not be relaxed; an increment that needs more is "
                "cut."},
               newton.maximum_iterations, {.at_least = 1, .at_most = 10000});
  read_integer(table,
               {"anderson_depth",
                "Number of earlier iterations that Anderson acceleration uses; 0 is plain Newton iteration, which "
                "needs more iterations because the tangents of grains are too stiff."},
               newton.anderson_depth, {.at_least = 0, .at_most = 50});
  newton.tangent = read_tangent(
      table,
      {"tangent",
       "Tangent of the grains, with which Newton iteration corrects the displacements: of the contacts as they move "
       "with the mean strain (`contact`), of the packing with free grains and all contacts sticking (`elastic`) or "
       "without the springs that have yielded (`static`), or of a small strain that goes on as the last motion did "
       "(`loading`, not on a GPU). `auto` is `elastic`, on a GPU `contact`. It decides the number of iterations and "
       "not the equilibrium."},
      newton.tangent);
  read_quantity(table, {"tangent_strain", "Size of the small strain whose response makes a `loading` tangent."},
                Dimension::none, newton.tangent_strain, {.at_least = "1e-8", .at_most = "1e-2"});
  read_quantity(table,
                {"initial_tangent_fraction",
                 "Share of the stage's first tangent that is added to every tangent, so that the equations stay "
                 "solvable where contacts open. It changes the way to equilibrium and not the equilibrium."},
                Dimension::none, newton.initial_tangent_fraction, {.at_least = "0", .at_most = "10"});
  read_quantity(table,
                {"relax_below",
                 "An increment without equilibrium is relaxed where its step is at most this share of a planned one, "
                 "and cut where it is larger; 0 relaxes none, 1 relaxes planned steps, too."},
                Dimension::none, newton.relax_below, {.at_least = "0", .at_most = "1"});
  read_integer(table, {"relax_attempts", "Number of iterations that an increment gets before it is relaxed."},
               newton.relax_attempts, {.at_least = 1, .at_most = 10000});
  read_quantity(table,
                {"relax_near",
                 "An increment is relaxed at once when the residual of an iteration is below this share of the "
                 "external force or of the reactions, whichever is larger; the way to equilibrium is short then."},
                Dimension::none, newton.relax_near, {.at_least = "0", .at_most = "0.5"});
  read_integer(table,
               {"relax_substeps",
                "Largest number of substeps of a relaxation, in each of which the grains move on and keep what they "
                "did; 0 forbids relaxation."},
               newton.relax_substeps, {.at_least = 0, .at_most = 10000});
  read_quantity(table, {"smallest_cut", "Smallest share of a planned step that cutting tries before the run gives up."},
                Dimension::none, newton.smallest_cut, {.at_least = "1e-6", .at_most = "1"});
  return newton;
}

OutputCase read_output(const io::Table& table) {
  OutputCase output;
  read_integer(
      table, {"every", "Number of increments between two result files; the last increment of a stage always has one."},
      output.every, {.at_least = 1, .at_most = 1'000'000});
  read_integer(table,
               {"checkpoint_every",
                "Number of increments between two checkpoints, from which `--resume` goes on; the last increment of a "
                "stage and of a run always has one."},
               output.checkpoint_every, {.at_least = 1, .at_most = 1'000'000});
  output.rves = table.integers({"rves",
                                "Numbers of the Gauss points whose whole packing is written with each result file, for "
                                "a look at single grains."},
                               {.at_least = 0, .at_most = 1'000'000'000}, std::vector<std::int64_t>{},
                               {.different = true});
  output.microstructure = read_microstructure(table);
  output.fields = table.chosen(
      {"fields", "Fields that result files hold (docs/reference/files.md); an empty list means all."},
      result_field_names());
  return output;
}

kernels::MicrostructureRequest read_microstructure(const io::Table& table) {
  kernels::MicrostructureRequest request;
  const io::Key key{
      "microstructure",
      "Quantities of the contact network that result files hold besides: the anisotropy and direction of its fabric, "
      "the coordination of grains that carry force, and the coordination in the networks of strong contacts."};
  for (const std::string& name : table.chosen(key, microstructure_names())) {
    if (!ask_for(name, request)) throw std::logic_error("a choice that was not offered");
  }
  return request;
}

}  // namespace voussoir::host
