#include "host/estimate/storage.hpp"

#include <algorithm>

#include "host/case/result_fields.hpp"
#include "host/packing/case_recipes.hpp"
#include "host/packing/packings.hpp"

namespace voussoir::host {
namespace {

// Measured values: 984 RVEs of 300 grains took 179.5 MB, checkpoints of 18.94 MB and result files of 278 kB; 3344 RVEs
// of 700 grains 915.8 MB, 148.1 MB and, with five whole RVEs, 1.33 MB.
constexpr double process_bytes = 73e6;    ///< memory of the program with its libraries
constexpr double memory_a_grain = 360.0;  ///< committed and trial state with room for four contacts a grain, and
                                          ///< a third one while an earlier state is held for a checkpoint
constexpr double memory_a_point = 6e3;    ///< matrix and factors; measured on rectangles of 1e4 to 1e5 elements
constexpr double contacts_a_grain = 1.93;
constexpr double nodes_a_point = 0.79;  ///< of the study's meshes: 3.16 nodes an element
constexpr double file_overhead = 30e3;  ///< attributes and groups of a result file

/// Size of a result file, with the copies for ParaView: vectors with a third component, and the means over the four
/// points of an element.
double result_file_bytes(const Case& input, double points, double nodes) {
  double bytes = file_overhead;
  int variety = 1, grains = input.packing.grains;
  const std::vector<SoilRecipe> recipes = recipes_of(input);
  for (const SoilRecipe& recipe : recipes) {
    variety = std::max(variety, recipe.packing->variety);
    grains = std::max(grains, recipe.packing->grains);
  }
  for (const ResultField& field : result_field_table) {
    if (!is_written(field, input.output) || (field.of_grains && recipes.empty())) continue;
    if (field.of_mix && variety == 1 && recipes.size() == 1) continue;
    if (field.of_accuracy && input.engine.accuracy == 0) continue;
    bytes += 8.0 * field.components * (field.location == io::FieldLocation::node ? 2.5 * nodes : 1.25 * points);
  }
  const double snapshot = 32.0 + 48.0 * contacts_a_grain;  // bytes a grain
  return bytes + static_cast<double>(input.output.rves.size()) * grains * snapshot;
}

}  // namespace

void add_storage(CaseSize& size, const Case& input) {
  const auto points = static_cast<double>(size.points);
  // Packings are made side by side in one batch, and so are tests. A mesh has its own matrix and its factors.
  double side_by_side = 0;
  for (const SoilRecipe& recipe : recipes_of(input)) {
    const auto made = static_cast<double>(count_of_packings(*recipe.packing));
    side_by_side = std::max(side_by_side, recipe.packing->grains * std::max(made, static_cast<double>(size.tests)));
  }
  size.memory = process_bytes + memory_a_grain * std::max(size.grains, side_by_side) + memory_a_point * points;
  if (size.points == 0) return;
  size.result_file = result_file_bytes(input, points,
                                       size.nodes > 0 ? static_cast<double>(size.nodes) : nodes_a_point * points);
  // A checkpoint holds committed RVEs (position and rotation, key and history of each contact) and the mesh's state.
  size.checkpoint = size.grains * (24.0 + 20.0 * contacts_a_grain) + 300.0 * points;
}

double mesh_memory(double points) { return process_bytes + memory_a_point * points; }

void add_curves(CaseSize& size, const BiaxialCase& test) {
  constexpr double bytes_a_sample = 300.0;  // a point of a curve, and its columns in the result file
  size.memory += bytes_a_sample * static_cast<double>(size.tests) * test.samples;
}

}  // namespace voussoir::host
