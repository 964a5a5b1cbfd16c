#pragma once
/// Stage "column": a rectangle of equal RVEs under gravity. Every point follows the same oedometric path, so that all
/// rows at all load factors are samples of one function K0 (sigma_yy).

#include <array>
#include <vector>

#include "host/record/columns.hpp"
#include "host/scene/k0_table.hpp"
#include "host/stages/ground_run.hpp"
#include "host/stages/stage.hpp"

namespace voussoir::host {

/// The parts of a case from which its column is made.
struct ColumnSetup {
  ColumnCase column;
  GroundCase soil;
  GravityCase gravity;
  MaterialCase material;
  StageSettings settings;
};
[[nodiscard]] ColumnSetup column_setup(const Case& input);

/// K0 (sigma_yy) of a material, measured on a column under its own weight.
struct ColumnResult {
  RunStatus status = RunStatus::finished;
  K0Table k0;                       ///< known only where the column is finished
  std::vector<StageTotals> totals;  ///< the column's costs
};

/// Starts the column in options.folder, or goes on with it. The column has results and checkpoints of its own, the
/// tables `k0` and `column_rows` of docs/reference/files.md, and k0.csv. `provenance` goes into its results.
[[nodiscard]] ColumnResult measure_k0(const ColumnSetup& setup, const RunOptions& options,
                                      const io::Provenance& provenance, RunLog& log);

/// The case kind "column": starts the column in options.folder, or goes on with it.
[[nodiscard]] RunStatus run_column(const Case& input, const RunOptions& options);

/// Table `k0` of docs/reference/files.md.
[[nodiscard]] std::vector<io::TableColumn> k0_columns(const K0Table& k0);

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
