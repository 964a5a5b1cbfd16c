#pragma once
/// The one table of the fields of result files (docs/reference/files.md). The record, the pool of RVEs, the mirrored
/// batch, the estimate of storage and the check of `output.fields` all read it. A new field needs a row here and the
/// line of code that computes its values; this line finds the row by its name when it is compiled. A value that has a
/// sign or a direction needs its `Mirror`, or it is wrong at every second point, which answers as a mirror image. A
/// value that is made of a number of kernels::RveReport must use one that `transfer_report`
/// (material/rve_pool_state.cpp) stores, or it is 0 after a run has been resumed.

#include <array>
#include <stdexcept>
#include <string_view>

#include "io/result_file.hpp"
#include "kernels/state/network.hpp"

namespace voussoir::host {

/// The change of a value where an RVE answers as its mirror image (x to -x).
enum class Mirror {
  none,         ///< the value stays; also for fields of the mesh, whose values come from mirrored answers
  sign,         ///< the value changes its sign
  axis_from_x,  ///< angle of an axis from x in (-pi/2, pi/2]: it changes its sign, but pi/2 (vertical) stays
};

struct ResultField {
  const char* name;
  const char* unit;
  int components;
  io::FieldLocation location = io::FieldLocation::gauss;
  bool of_grains = false;  ///< the field exists only where the material is made of grains
  Mirror mirror = Mirror::none;
  /// The request without which the field is not written; nullptr: the field is always written.
  bool kernels::MicrostructureRequest::* request = nullptr;
  /// Takes the value from the kernels' report of a contact network; nullptr where the field is no part of this report.
  double (*of_network)(const kernels::Microstructure&) = nullptr;
  bool of_mix = false;       ///< the field exists only where the points hold several packings
  bool of_accuracy = false;  ///< the field exists only where `engine.accuracy` is asked for
};

namespace result_field_rows {

using enum io::FieldLocation;
using enum Mirror;
using Request = kernels::MicrostructureRequest;
using Network = kernels::Microstructure;

static_assert(kernels::strong_thresholds == std::array{1.0, 2.0, 2.5}, "the names below say the thresholds");

/// The rows stand in the order in which files have the fields.
// Not `inline`: the sanitizer's checks of null pointers are no constant expressions for objects that the linker may
// merge, and result_field() is computed by the compiler.
constexpr auto table = std::to_array<ResultField>({
    {"displacement", "m", 2, node},
    {"reaction", "N/m", 2, node},
    {"gauss_point_coordinates", "m", 2, gauss},
    {"stress", "Pa", 3, gauss},
    {"mean_stress", "Pa", 1, gauss},
    {"deviatoric_stress", "Pa", 1, gauss},
    {"strain", "-", 3, gauss},
    {"volumetric_strain", "-", 1, gauss},
    {"deviatoric_strain", "-", 1, gauss},
    {"void_ratio", "-", 1, gauss, true},
    {"grain_rotation", "rad", 1, gauss, true, sign, nullptr, [](const Network& n) { return n.grain_rotation; }},
    {"coordination", "-", 1, gauss, true, none, nullptr, [](const Network& n) { return n.coordination; }},
    {"rve_status", "-", 1, gauss, true},
    {"unbalanced_ratio", "-", 1, gauss, true},
    {"inertial_number", "-", 1, gauss, true},
    {"steps", "-", 1, gauss, true},
    {.name = "packing", .unit = "-", .components = 1, .of_grains = true, .of_mix = true},
    {.name = "expected_error", .unit = "-", .components = 1, .of_grains = true, .of_accuracy = true},
    {"fabric_anisotropy", "-", 1, gauss, true, none, &Request::fabric,
     [](const Network& n) { return n.fabric_anisotropy; }},
    {"fabric_direction", "rad", 1, gauss, true, axis_from_x, &Request::fabric,
     [](const Network& n) { return n.fabric_direction; }},
    {"mechanical_coordination", "-", 1, gauss, true, none, &Request::coordination,
     [](const Network& n) { return n.mechanical_coordination; }},
    {"strong_coordination_1", "-", 1, gauss, true, none, &Request::strong_networks,
     [](const Network& n) { return n.strong_coordination[0]; }},
    {"strong_coordination_2", "-", 1, gauss, true, none, &Request::strong_networks,
     [](const Network& n) { return n.strong_coordination[1]; }},
    {"strong_coordination_2_5", "-", 1, gauss, true, none, &Request::strong_networks,
     [](const Network& n) { return n.strong_coordination[2]; }},
});

}  // namespace result_field_rows

static constexpr const auto& result_field_table = result_field_rows::table;

/// The row of a name; nullptr where the table has no such row.
[[nodiscard]] constexpr const ResultField* find_result_field(std::string_view name) {
  for (const ResultField& field : result_field_table) {
    if (name == field.name) return &field;
  }
  return nullptr;
}

/// The row of a name that stands in the code. The lookup is done by the compiler: a name that the table lacks is an
/// error of compilation.
[[nodiscard]] consteval const ResultField& result_field(std::string_view name) {
  const ResultField* found = find_result_field(name);
  if (found == nullptr) throw std::invalid_argument("result_field_table has no field of this name");
  return *found;
}

/// False where a record with this request does not have the field.
[[nodiscard]] constexpr bool is_asked_for(const ResultField& field, const kernels::MicrostructureRequest& wanted) {
  return field.request == nullptr || wanted.*field.request;
}

struct OutputCase;

/// Whether result files hold a field, where the material has it.
[[nodiscard]] bool is_written(const ResultField& field, const OutputCase& output);

/// What `output.microstructure` asks for, without the quantities of which `output.fields` keeps no field.
[[nodiscard]] kernels::MicrostructureRequest written_quantities(const OutputCase& output);

[[nodiscard]] std::vector<std::string> result_field_names();

/// What an entry of `output.microstructure` may be.
[[nodiscard]] std::vector<std::string> microstructure_names();

/// Adds the quantity that such an entry names to the request; false where there is no such quantity.
[[nodiscard]] bool ask_for(std::string_view name, kernels::MicrostructureRequest& request);

}  // namespace voussoir::host
