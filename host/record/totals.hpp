#pragma once
/// What a run has cost, stage by stage: kept in its checkpoints and told at the end of its log.

#include <string>
#include <vector>

#include "fem/part_times.hpp"
#include "io/checkpoint.hpp"

namespace voussoir::host {

struct StageTotals {
  std::string stage;
  std::vector<double> evaluations;      ///< of each increment, cut tries included
  std::vector<double> unsettled;        ///< of each increment, points that ended at the step limit: not at rest
  std::vector<double> unsettled_share;  ///< of each increment: were they off by their pressure, the residual by so much
                                        ///< of the tolerance [-]
  std::vector<double> deferral_error;   ///< of each increment, over pressure; none unless RVEs may be deferred [-]
  int cuts = 0;                         ///< tries that did not converge
  double particle_steps = 0;
  fem::PartTimes parts;
  double output = 0;  ///< result files and checkpoints [s]
  double wall = 0;    ///< all of it [s]
};

void save(const std::vector<StageTotals>& totals, io::Checkpoint& checkpoint);
/// Empty where the checkpoint holds none.
[[nodiscard]] std::vector<StageTotals> totals_from(const io::Checkpoint& checkpoint);

/// Which of the stage's increments ended with points that are not at rest; empty: none.
/// @param points of the mesh
[[nodiscard]] std::string unsettled_line(const StageTotals& stage, std::size_t points);

/// By how much the stage's deferred answers were off (host/deferral.hpp); empty: none may be deferred.
/// @param bound `engine.defer`
[[nodiscard]] std::string deferral_line(const StageTotals& stage, double bound);

/// Lines of a table, one row a stage and a sum: increments, wall time by part [s], evaluations an increment (median and
/// largest), cuts, particle-steps and their rate.
[[nodiscard]] std::vector<std::string> totals_table(const std::vector<StageTotals>& totals);

}  // namespace voussoir::host
