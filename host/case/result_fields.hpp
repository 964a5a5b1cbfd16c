#pragma once
/// The fields of result files (io/FORMAT.md): one table, from which the record, the pool of RVEs, the mirrored batch,
/// the estimate of storage and the check of `output.fields` all read. A new field is a row here and the line that
/// computes its values, which finds the row by its name. A value that has a sign or a direction needs its `Mirror`
/// here, or half of the points tell it the wrong way round. A value made of a number of kernels::RveReport must use one
/// that `transfer_report` (material/rve_pool_state.cpp) stores, or it is 0 after a run has been resumed.

#include <array>
#include <stdexcept>
#include <string_view>

#include "io/result_file.hpp"
#include "kernels/state/network.hpp"

namespace voussoir::host {

/// What becomes of a value where an RVE answers as its mirror image (x to -x).
enum class Mirror {
  none,         ///< it stays; so do fields of the mesh, which are made from answers that are mirrored already
  sign,         ///< it changes its sign
  axis_from_x,  ///< an axis' angle from x in (-pi/2, pi/2]: it changes its sign, but the vertical stays
};

struct ResultField {
  const char* name;
  const char* unit;
  int components;
  io::FieldLocation location = io::FieldLocation::gauss;
  bool of_grains = false;  ///< only where the material is made of grains
  Mirror mirror = Mirror::none;
  /// Written only where this is asked for; nullptr: always.
  bool kernels::MicrostructureRequest::* request = nullptr;
  /// Its value in what the kernels tell of a contact network; nullptr: it is no quantity of the network.
  double (*of_network)(const kernels::Microstructure&) = nullptr;
};

namespace result_field_rows {

using enum io::FieldLocation;
using enum Mirror;
using Request = kernels::MicrostructureRequest;
using Network = kernels::Microstructure;

static_assert(kernels::strong_thresholds == std::array{1.0, 2.0, 2.5}, "the names below say the thresholds");

/// In the order in which files have them.
inline constexpr auto table = std::to_array<ResultField>({
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

inline constexpr const auto& result_field_table = result_field_rows::table;

/// The row of a name; nullptr where the table has none.
[[nodiscard]] constexpr const ResultField* find_result_field(std::string_view name) {
  for (const ResultField& field : result_field_table) {
    if (name == field.name) return &field;
  }
  return nullptr;
}

/// The row of a name that the code itself writes: a name that the table lacks does not compile.
[[nodiscard]] consteval const ResultField& result_field(std::string_view name) {
  const ResultField* found = find_result_field(name);
  if (found == nullptr) throw std::invalid_argument("result_field_table has no field of this name");
  return *found;
}

/// Whether a record with this request has the field, as far as the request decides it.
[[nodiscard]] constexpr bool is_asked_for(const ResultField& field, const kernels::MicrostructureRequest& wanted) {
  return field.request == nullptr || wanted.*field.request;
}

/// Adds what an entry of `output.microstructure` names; false where it names nothing.
[[nodiscard]] bool ask_for(std::string_view name, kernels::MicrostructureRequest& request);

}  // namespace voussoir::host
