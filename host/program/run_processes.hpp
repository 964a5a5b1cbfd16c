#pragma once
/// Several runs, each a process of its own, so that it behaves as it does alone: what sweeps and ensembles share.

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "host/program/sweep_outcome.hpp"

namespace voussoir::host {

struct ProcessRun {
  std::string name;
  std::filesystem::path case_file;
  std::vector<std::string> overrides;
  std::filesystem::path folder;
  RunEnd end = {};
  std::string reason = {};  ///< last line of its standard error, where ProcessOptions::complaints keeps it
};

struct ProcessOptions {
  std::filesystem::path program;  ///< this program, which is started once for each run
  int processes = 1;              ///< runs at a time
  int threads = 0;                ///< of each run; 0: its default
  bool resume = false;
  bool take_over = false;  ///< see RunOptions; for the folders of the runs
  /// The file that takes the standard error of a run while it lasts; it is shown when the run has ended, and removed.
  /// Nothing: a run writes to the standard error of this process.
  std::function<std::filesystem::path(const ProcessRun&)> complaints = {};
  std::function<void(const ProcessRun&)> on_end = {};  ///< called when a run has ended; may be empty
};

/// Runs the case of each of `runs`, some at a time in their order, and stores how each ended. A request to stop
/// (interrupt.hpp) is passed on to the runs that have begun, and no further run is started. Throws std::system_error
/// where no process can be started, after the runs that have begun are stopped.
void run_processes(std::span<ProcessRun> runs, const ProcessOptions& options);

/// The threads of one run: the available cores, shared among the runs at a time, where nobody has said a number.
[[nodiscard]] int threads_of_a_run(const ProcessOptions& options);

}  // namespace voussoir::host
