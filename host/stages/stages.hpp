#pragma once
/// The stages of the ground (method.md, section 4), each a function that goes on where the ground stands.

#include <string>
#include <vector>

#include "host/stages/ground.hpp"
#include "host/stages/k0_table.hpp"
#include "host/stages/stage_driver.hpp"

namespace voussoir::host {

/// K0 (sigma_yy) of the case's material, measured on a column under its own weight (stages: "column").
struct ColumnResult {
  RunStatus status = RunStatus::finished;
  K0Table k0;
  std::vector<StageTotals> totals;  ///< what it cost
};
/// Runs, or goes on with, the column in options.folder, with its own results and checkpoints, tables `k0` and
/// `column_rows` of io/FORMAT.md, and k0.csv.
[[nodiscard]] ColumnResult run_column(const Case& input, const RunOptions& options, RunLog& log);

/// The table `k0` of io/FORMAT.md.
[[nodiscard]] std::vector<io::TableColumn> k0_columns(const K0Table& k0);

/// From the isotropic initial state to geostatic equilibrium on the fixed mesh (stage "gravity"); the opening is held
/// by the tractions of eqs. (15), (16). `last`: the run ends here.
[[nodiscard]] RunStatus settle_under_gravity(Ground& ground, const K0Table& k0, RunRecorder& recorder, bool last);

/// Eccentric volume loss, eqs. (17)-(19), from V_l = 0 (stage "volume_loss"). Starts a new stage of the ground unless
/// `resumed`; the opening is fixed where it stands.
[[nodiscard]] RunStatus lose_volume(Ground& ground, const K0Table& k0, RunRecorder& recorder, bool resumed);

/// Load factors of the increments of column and gravity.
[[nodiscard]] std::vector<double> gravity_targets(const Case& input);

/// Nodal forces of weight and surcharge at load factor lambda [N/m].
[[nodiscard]] Eigen::VectorXd ground_weight(const fem::Mesh& mesh, const GroundCase& ground, double load_factor);

/// Tractions that hold the opening at load factor lambda, eqs. (15), (16) [N/m].
[[nodiscard]] Eigen::VectorXd opening_tractions(const fem::Mesh& mesh, const GroundCase& ground, const K0Table& k0,
                                                double load_factor);

/// Base fixed, sides and symmetry axis on rollers.
[[nodiscard]] fem::Constraints ground_supports(const fem::Mesh& mesh);

/// A level band of the ground after gravity, means over its points weighted by their volume.
struct GeostaticRow {
  double depth = 0;       ///< of its middle [m]
  double vertical = 0;    ///< vertical stress, compression positive, brought to that depth by the unit weight [Pa]
  double error = 0;       ///< mean of vertical stress - (unit weight * depth + surcharge) [Pa]
  double scatter = 0;     ///< standard deviation of the same [Pa]
  double k0 = 0;          ///< horizontal over vertical stress [-]
  double deflection = 0;  ///< of the principal axis from the vertical, without sign [rad]
};

/// How near the ground after gravity is to the state at rest; Gauss points farther than D/2 from the opening.
struct GeostaticCheck {
  double vertical_error = 0;  ///< largest |sigma_yy - (unit weight * depth + surcharge)| [Pa]
  double vertical_ratio = 0;  ///< the same, over (5 % of the expected stress + 1 kPa) [-]; at most 1 is wanted
  double row_ratio = 0;    ///< largest |error| of a row over (2 % of the expected stress + 0.5 kPa) [-]; at most 1 is
                           ///< wanted
  double row_scatter = 0;  ///< largest scatter of a row over its vertical stress [-]
  double k0_minimum = 1;   ///< least horizontal over vertical stress [-]
  double k0_maximum = 0;   ///< largest [-]
  double deflection_mean = 0;  ///< of the principal axis from the vertical [rad]
  double deflection_max = 0;   ///< [rad]
  double deflection_deep = 0;  ///< largest where the vertical stress is 100 kPa or more [rad]; at most 1 deg is wanted
  std::vector<GeostaticRow> rows;  ///< from the surface down; rows without points are left out
};
[[nodiscard]] GeostaticCheck check_geostatic(const Ground& ground);

/// Reactions of the opening, fixed where it stands, against the tractions that held it.
struct OpeningCheck {
  double difference = 0;      ///< |reactions - tractions| over the opening's free directions [N/m]
  double relative = 0;        ///< the same, over |tractions| [-]
  Eigen::VectorXd reactions;  ///< of all supports on the ground, n_dofs [N/m]
};
[[nodiscard]] OpeningCheck check_opening(const Ground& ground, const K0Table& k0);

}  // namespace voussoir::host
