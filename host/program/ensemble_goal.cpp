#include "host/program/ensemble_goal.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "host/ensemble/member.hpp"
#include "host/kinds/biaxial_bvp.hpp"
#include "host/kinds/column.hpp"
#include "host/kinds/tunnel.hpp"
#include "host/scene/boundary_columns.hpp"
#include "host/scene/records.hpp"
#include "host/scene/scene_of.hpp"
#include "io/input_error.hpp"
#include "io/text_file.hpp"
#include "io/units.hpp"

namespace voussoir::host {
namespace {

template <class Report, std::size_t n>
std::vector<std::string> names_of(const std::array<Column<Report>, n>& columns) {
  std::vector<std::string> names;
  for (const Column<Report>& column : columns) names.emplace_back(column.name);
  return names;
}

/// The columns of points and regions first, then those of boundaries.
std::vector<std::string> results_of_scene(const Case& input) {
  const PlannedScene planned = planned_scene(input);
  std::vector<std::string> names = column_names(planned.records);
  for (std::string& name : column_names(watched(planned.plans), planned.scene.mesh)) names.push_back(std::move(name));
  return names;
}

/// The reaction of what the last stage of a scene moves, along its larger motion; else the first column of all.
std::string default_result_of_scene(const Case& input) {
  for (const MoveCase& move : input.scene.stages.back().moves) {
    if (move.boundary.empty() || move.is_affine()) continue;
    const bool along_x = std::abs(move.x.value_or(0)) > std::abs(move.y.value_or(0));
    return fmt::format("reaction_{}_{}", move.boundary, along_x ? "x" : "y");
  }
  return results_of_scene(input).front();
}

std::string default_result(const Case& input) {
  if (input.kind == CaseKind::scene) return default_result_of_scene(input);
  if (input.kind == CaseKind::column) return "k0_at_base";
  return input.kind == CaseKind::biaxial_bvp ? "axial_stress" : "surface_settlement";
}

/// The names of the results that the last increment of a kind on a mesh has.
std::vector<std::string> results_of_kind(const Case& input) {
  if (input.kind == CaseKind::column) return names_of(column_base_columns);
  if (input.kind == CaseKind::biaxial_bvp) return names_of(specimen_columns);
  if (input.kind == CaseKind::scene) return results_of_scene(input);
  std::vector<std::string> names = names_of(tunnel_columns);
  const auto written = [&](const char* field) {
    const std::vector<std::string>& fields = input.output.fields;
    return fields.empty() || std::find(fields.begin(), fields.end(), field) != fields.end();
  };
  if (written("displacement")) names.insert(names.end(), trough_columns.begin(), trough_columns.end());
  if (written("stress")) names.insert(names.end(), reaction_columns.begin(), reaction_columns.end());
  return names;
}

}  // namespace

std::optional<Goal> goal_of(const Case& input, const std::string& until, const std::string& result) {
  if (until.empty()) return std::nullopt;
  Goal goal;
  try {
    goal.share = io::parse_quantity(until, io::Dimension::none);
  } catch (const io::UnitError& error) {
    throw io::InputError("--until", "", error.what());
  }
  if (!(goal.share > 0) || goal.share >= 1)
    throw io::InputError("--until", "",
                         "must be a share between 0 and 1, such as \"5 %\", is " + io::in_one_line(until));
  const std::vector<std::string> names = results_of_kind(input);
  goal.result = result.empty() ? default_result(input) : result;
  if (std::find(names.begin(), names.end(), goal.result) == names.end()) {
    throw io::InputError(
        "--result", "",
        fmt::format("is {}; results of this case are {}", io::in_one_line(goal.result), fmt::join(names, ", ")));
  }
  return goal;
}

}  // namespace voussoir::host
