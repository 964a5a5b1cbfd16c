#pragma once
/// What is read of a run that has ended: its row of summary.csv, and what means over several runs are made of.

#include <optional>

#include "host/ensemble/member.hpp"
#include "host/program/run_processes.hpp"
#include "io/sweep_file.hpp"

namespace voussoir::host {

struct ReadRun {
  io::SweepRow row = {};
  std::optional<MemberResults> results = {};  ///< of a run on a mesh whose files could be read
};

/// Reads a run: how it ended, what it cost, its results. Where its files are damaged, one line on standard error says
/// so, the row has no results, and a run that had come to its end counts as a machine failure: another try may succeed.
/// A run that was refused (wrong input) has no results; what lies in its folder is not of this case.
[[nodiscard]] ReadRun read_run(ProcessRun& run);

}  // namespace voussoir::host
