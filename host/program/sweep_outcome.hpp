#pragma once
/// How the runs of a sweep ended, and how therefore the sweep ended.

#include <optional>
#include <span>
#include <string>

#include "host/process/exit_code.hpp"

namespace voussoir::host {

/// The end of one run. A run that was not started has neither outcome nor signal.
struct RunEnd {
  std::optional<Outcome> outcome = {};
  int code = -1;   ///< exit code of the process, 128 + signal where a signal killed it; -1: not run
  int signal = 0;  ///< the signal that killed it
};

/// @param status what waitpid tells
/// @param stopped true where the sweep had asked the run to stop
[[nodiscard]] RunEnd end_of(int status, bool stopped);

/// The same of an exit code that was kept, 128 + signal where a signal killed the run.
[[nodiscard]] RunEnd end_of_code(int code);

/// In the summary: the name of the outcome, "killed by SIGKILL" or "not run".
[[nodiscard]] std::string name_of(const RunEnd& end);

/// The first of these that holds for a run: interrupted (`--resume` goes on), machine failure (another try may
/// succeed), wrong input, no equilibrium (no other try would change these two); done where all are. A run that was not
/// started counts as interrupted: `--resume` starts it.
[[nodiscard]] Outcome outcome_of(std::span<const RunEnd> runs);

/// The rule of outcome_of for `--help`.
inline constexpr const char* sweep_rule =
    "Sweeps and ensembles tell in summary.csv how each run ended. Their own exit status is the first of these that "
    "holds for a run: 130 (a run was stopped, or was not started), 4, 2, 3; 0 where all runs are done. "
    " A run that a signal killed counts as 4.";

}  // namespace voussoir::host
