#pragma once
/// The results of a sweep: sweep.h5, one row a run. docs/reference/files.md lists every dataset.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "io/result_data.hpp"

namespace voussoir::io {

struct SweepRow {
  std::string name = {};
  std::string status = {};
  int exit_code = 0;
  std::string reason = {};
  std::string kind = {};
  std::string grid = {};
  std::string point = {};
  std::map<std::string, std::string> axes = {};  ///< value by name of the axis
  std::string stage = {};                        ///< of the last increment
  double load_parameter = 0;
  double iterations = 0;
  double particle_steps = 0;
  double wall_time = 0;  ///< [s]
  Quantities results = {};
};

struct SweepData {
  std::string input = {};  ///< the sweep file
  std::vector<SweepRow> runs = {};
  std::vector<std::string> ensembles = {};  ///< folders, below the sweep's, that hold an ensemble.h5
};

/// The names of the axes of all runs, each once, in alphabetical order; the same for their results.
[[nodiscard]] std::vector<std::string> axes_of(const std::vector<SweepRow>& runs);
[[nodiscard]] std::vector<std::string> results_of(const std::vector<SweepRow>& runs);

/// Throws std::runtime_error naming file and reason.
void write_sweep(const std::filesystem::path& file, const SweepData& data);

/// One line for each run, with a heading: name, status, exit code, axes, stage, cost, results. A field is empty where a
/// run has no such axis or result.
[[nodiscard]] std::string summary_csv(const std::vector<SweepRow>& runs);

}  // namespace voussoir::io
