#pragma once
/// The costs of a run, stage by stage. Checkpoints keep them, and the log shows them at its end.

#include <string>
#include <vector>

#include "fem/part_times.hpp"
#include "io/checkpoint.hpp"

namespace voussoir::host {

/// Time of the thread that writes result files and checkpoints.
struct WriterTime {
  double wall = 0;       ///< [s]
  double processor = 0;  ///< [s]

  [[nodiscard]] static WriterTime now();  ///< of the calling thread, from some moment on
  [[nodiscard]] WriterTime operator-(const WriterTime& o) const { return {wall - o.wall, processor - o.processor}; }
  WriterTime& operator+=(const WriterTime& o) {
    wall += o.wall;
    processor += o.processor;
    return *this;
  }
};

struct StageTotals {
  std::string stage;
  std::vector<double> evaluations;          ///< evaluations of each increment, those of tries that were cut included
  std::vector<double> step_limit_points;    ///< EquilibriumReport::step_limit_points of each increment
  std::vector<double> unsettled;            ///< EquilibriumReport::unsettled of each increment [-]
  std::vector<double> out_of_range_points;  ///< EquilibriumReport::out_of_range_points of each increment; of grains
                                            ///< only
  std::vector<double> mean_overlap;         ///< EquilibriumReport::mean_overlap of each increment; of grains only [-]
  std::vector<double> deferral_error;  ///< EquilibriumReport::deferral_error of each increment; empty without deferral
  int cuts = 0;                        ///< tries that did not converge
  double particle_steps = 0;           ///< steps of grains
  double lane_steps = 0;  ///< steps of lanes, as fem::BatchReport::lane_steps; not a number where a checkpoint of an
                          ///< earlier version did not say how many there were
  fem::PartTimes parts;   ///< wall time by part; checkpoints of earlier versions counted tangents with the material
  double output = 0;      ///< wall time that the increments waited for result files and checkpoints [s]
  WriterTime writer;      ///< spent on these files meanwhile
  double wall = 0;        ///< wall time of the whole stage [s]
};

void save(const std::vector<StageTotals>& totals, io::Checkpoint& checkpoint);
/// The totals that a checkpoint holds; empty where it holds none.
[[nodiscard]] std::vector<StageTotals> totals_from(const io::Checkpoint& checkpoint);

/// A sentence that says how many of the stage's increments ended with RVEs that are not at rest; empty where none did.
/// @param points number of points of the mesh
[[nodiscard]] std::string unsettled_line(const StageTotals& stage, std::size_t points);

/// A sentence that says how many of the stage's increments ended with RVEs beyond what the contact law is good for;
/// empty where none did. @param points number of points of the mesh
[[nodiscard]] std::string range_line(const StageTotals& stage, std::size_t points);

/// A sentence that says by how much the stage's deferred answers were off (host/material/deferral.hpp); empty where
/// RVEs may not be deferred.
/// @param bound `engine.defer`
[[nodiscard]] std::string deferral_line(const StageTotals& stage, double bound);

/// A sentence that says which share of the lanes' steps moved a grain: lanes wait for the slowest RVE of their group.
/// Empty where no lanes have worked, or where their number is not known.
[[nodiscard]] std::string lanes_line(const StageTotals& stage);

/// The lines of a table with one row for each stage and one for their sum: increments, wall time by part [s],
/// evaluations of an increment (median and largest), cuts, particle-steps and their rate, and the writer's time.
[[nodiscard]] std::vector<std::string> totals_table(const std::vector<StageTotals>& totals);

}  // namespace voussoir::host
