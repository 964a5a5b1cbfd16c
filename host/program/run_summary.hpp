#pragma once
/// The table of several runs, summary.csv.

#include <filesystem>
#include <span>

#include "host/program/run_processes.hpp"

namespace voussoir::host {

/// Writes one row for each run: how it ended, and the further columns of its last increment.
void write_summary(std::span<const ProcessRun> runs, const std::filesystem::path& file);

}  // namespace voussoir::host
