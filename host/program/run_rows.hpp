#pragma once
/// The table of several runs: what summary.csv says of them.

#include <filesystem>
#include <span>
#include <vector>

#include "host/program/run_processes.hpp"
#include "io/sweep_file.hpp"

namespace voussoir::host {

/// The row of a run: how it ended, what it cost, its results. Where its files are damaged, one line on standard error
/// says so, and the row has no results.
[[nodiscard]] io::SweepRow row_of(const ProcessRun& run);

/// Writes summary.csv with one row for each run.
void write_summary(std::span<const ProcessRun> runs, const std::filesystem::path& file);

}  // namespace voussoir::host
