#pragma once
/// The table of several runs: what summary.csv says of them.

#include <filesystem>
#include <span>
#include <vector>

#include "host/program/run_processes.hpp"
#include "io/sweep_file.hpp"

namespace voussoir::host {

/// The row of a run: how it ended, what it cost, its results. Where its files are damaged, one line on standard error
/// says so, the row has no results, and a run that had come to its end counts as a machine failure: another try may
/// succeed. A run that was refused (wrong input) has no results; what lies in its folder is not of this case.
[[nodiscard]] io::SweepRow row_of(ProcessRun& run);

/// Writes summary.csv with one row for each run (row_of).
void write_summary(std::span<ProcessRun> runs, const std::filesystem::path& file);

}  // namespace voussoir::host
