#pragma once
/// The reports of an increment of a stage. They stay structs with named members until a result file is
/// written; the tables below state the name and the unit of each column. A new column needs a member, a row in the
/// table beside it, the line that sets the member, and its line in docs/reference/files.md.
///
/// An increment may consist of several converged steps, and of tries that were cut. What must be summed over them, or
/// be the largest of them, goes through `StageRun::Effort` (host/stages/stage_run.hpp).

#include <array>
#include <cstddef>
#include <optional>

#include "host/record/columns.hpp"
#include "io/result_data.hpp"

namespace voussoir::host {

/// How the equilibrium of an increment was found, and the effort that it took.
struct EquilibriumReport {
  double largest_nodal_ratio = 0;  ///< as fem::NewtonReport::largest_nodal_ratio [-]
  /// The bound of the residual, over the same reference as the residual: the tolerance, and the noise floor that the
  /// stresses of the points add to it [-].
  double residual_bound = 0;
  double noise_floor = 0;             ///< the part of the bound that is noise [N/m]
  std::size_t open_points = 0;        ///< RVEs without any contact
  std::size_t step_limit_points = 0;  ///< RVEs whose hold ended at its cap: their grains are not at rest
  /// RVEs beyond what the contact law is good for (packing/law_range.hpp): they count, but their overlaps are not
  /// small.
  std::optional<std::size_t> out_of_range_points = {};
  std::optional<double> mean_overlap = {};  ///< the largest mean overlap over r_i + r_j of an RVE [-]
  /// If the stresses of the RVEs at the step limit were wrong by as much as their pressure, the residual would be wrong
  /// by this share of the tolerance [-].
  double unsettled = 0;
  std::optional<std::size_t> slowest_point = {};  ///< the RVE that took most steps; none for a continuum
  std::optional<int> slowest_steps = {};          ///< the steps that it took
  int relaxations = 0;                            ///< substeps of relaxations that were committed
  double viscous_work = 0;                        ///< energy dissipated by these substeps [J/m]
  /// RVEs that answered by their tangent at the last iterate; none unless `engine.defer` lets RVEs do so.
  std::optional<std::size_t> deferred_points = {};
  /// Largest error of such answers that the grains have shown in this increment, over the RVE's pressure [-].
  std::optional<double> deferral_error = {};
  double time_grains = 0;    ///< wall time of the material without its tangents [s]
  double time_tangents = 0;  ///< wall time of the material's tangents [s]
  double time_assembly = 0;  ///< wall time of gradients, nodal forces and stiffness [s]
  double time_solve = 0;     ///< wall time of factorisations and solutions [s]
  double time_output = 0;    ///< wall time that the increment before waited for its files and for earlier ones [s]
  double peak_memory = 0;    ///< largest resident memory of this process so far [B]
};

inline constexpr auto equilibrium_columns = std::to_array<Column<EquilibriumReport>>({
    {"largest_nodal_ratio", "-", &EquilibriumReport::largest_nodal_ratio},
    {"residual_bound", "-", &EquilibriumReport::residual_bound},
    {"noise_floor", "N/m", &EquilibriumReport::noise_floor},
    {"open_points", "-", &EquilibriumReport::open_points},
    {"step_limit_points", "-", &EquilibriumReport::step_limit_points},
    {"unsettled", "-", &EquilibriumReport::unsettled},
    {"out_of_range_points", "-", &EquilibriumReport::out_of_range_points},
    {"mean_overlap", "-", &EquilibriumReport::mean_overlap},
    {"slowest_point", "-", &EquilibriumReport::slowest_point},
    {"slowest_steps", "-", &EquilibriumReport::slowest_steps},
    {"relaxations", "-", &EquilibriumReport::relaxations},
    {"viscous_work", "J/m", &EquilibriumReport::viscous_work},
    {"deferred_points", "-", &EquilibriumReport::deferred_points},
    {"deferral_error", "-", &EquilibriumReport::deferral_error},
    {"time_grains", "s", &EquilibriumReport::time_grains},
    {"time_tangents", "s", &EquilibriumReport::time_tangents},
    {"time_assembly", "s", &EquilibriumReport::time_assembly},
    {"time_solve", "s", &EquilibriumReport::time_solve},
    {"time_output", "s", &EquilibriumReport::time_output},
    {"peak_memory", "B", &EquilibriumReport::peak_memory},
});

struct IncrementReport {
  /// The part of the report that every result file has. The recorder sets `index`; a stage adds columns of its own to
  /// `extra`; the columns of the tables below are added where the report is written.
  io::IncrementInfo info;
  double volume_loss = 0;  ///< V_l of the tunnel; 0 in stages and kinds that lose no volume [-]
  std::optional<EquilibriumReport> equilibrium = {};  ///< none for the state at the start of a stage
};

inline constexpr auto increment_columns = std::to_array<Column<IncrementReport>>({
    {"volume_loss", "-", &IncrementReport::volume_loss},
});

/// The report in the form that a result file has.
[[nodiscard]] inline io::IncrementInfo row_of(const IncrementReport& report) {
  io::IncrementInfo row = report.info;
  add_columns(report, increment_columns, row.extra);
  if (report.equilibrium) add_columns(*report.equilibrium, equilibrium_columns, row.extra);
  return row;
}

}  // namespace voussoir::host
