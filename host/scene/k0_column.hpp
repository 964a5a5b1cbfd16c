#pragma once
/// The column that measures K0 (sigma_yy): a single row of elements of level layers under gravity. Every point of a
/// layer follows the same oedometric path, so that its rows at all load factors are samples of one function.

#include <array>
#include <vector>

#include "host/record/columns.hpp"
#include "host/scene/k0_table.hpp"
#include "host/scene/rest.hpp"
#include "host/stages/ground_run.hpp"
#include "host/stages/stage.hpp"

namespace voussoir::host {

/// The parts of a case from which its column is made.
struct ColumnSetup {
  ColumnCase column = {};
  std::vector<GroundLayer> layers = {};  ///< from the surface down
  double surcharge = 1e3;                ///< on the surface, and isotropic pressure at the start [Pa]
  GravityCase gravity = {};
  MaterialCase material = {};
  StageSettings settings = {};
};
/// The column of a case with [ground].
[[nodiscard]] ColumnSetup column_setup(const Case& input);

/// K0 (sigma_yy) of each layer's material, measured on a column under its own weight.
struct ColumnResult {
  RunStatus status = RunStatus::finished;
  std::vector<K0Table> k0 = {};  ///< of each layer, from the surface down; empty where the column is not finished
  std::vector<StageTotals> totals = {};  ///< the column's costs
};

/// Starts the column in options.folder, or goes on with it. The column has results and checkpoints of its own, the
/// tables `k0` and `column_rows` of docs/reference/files.md, and k0.csv; with several layers there is a table of each,
/// `k0_REGION` and k0_REGION.csv. `provenance` goes into its results.
[[nodiscard]] ColumnResult measure_k0(const ColumnSetup& setup, const RunOptions& options,
                                      const io::Provenance& provenance, RunLog& log);

/// The column of a larger run, which is a run of its own in the folder `column` of the run.
[[nodiscard]] ColumnResult run_own_column(ColumnSetup setup, const Case& input, const RunOptions& options, RunLog& log);

/// Table `k0` of docs/reference/files.md.
[[nodiscard]] std::vector<io::TableColumn> k0_columns(const K0Table& k0);

/// The name of a layer's table: `k0`, with several layers `k0_REGION`.
[[nodiscard]] std::string k0_name(const std::vector<GroundLayer>& layers, std::size_t layer);

/// One row of Gauss points of the column, averaged.
struct ColumnRow {
  double vertical = 0;    ///< vertical stress, compression positive [Pa]
  double ratio = 0;       ///< horizontal over vertical stress [-]
  double deflection = 0;  ///< angle of the principal axis from the vertical, signed [rad]
};

/// Table `column_rows` of docs/reference/files.md.
inline constexpr auto column_row_columns = std::to_array<Column<ColumnRow>>({
    {"vertical_stress", "Pa", &ColumnRow::vertical},
    {"ratio", "-", &ColumnRow::ratio},
    {"deflection", "rad", &ColumnRow::deflection},
});

/// The deepest row, as columns of an increment.
inline constexpr auto column_base_columns = std::to_array<Column<ColumnRow>>({
    {"k0_at_base", "-", &ColumnRow::ratio},
    {"deflection_at_base", "rad", &ColumnRow::deflection},
});

}  // namespace voussoir::host
