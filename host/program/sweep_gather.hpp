#pragma once
/// What a sweep leaves when its runs have ended, whoever ran them.

#include <filesystem>
#include <string>

#include "host/process/exit_code.hpp"
#include "host/program/run_processes.hpp"
#include "host/record/run_lock.hpp"
#include "host/sweep/sweep_file.hpp"

namespace voussoir::host {

/// Keeps how a run ended in the folder of its sweep (outcome_path).
void keep_outcome(const std::filesystem::path& folder, const ProcessRun& run);

/// Writes summary.csv and sweep.h5, reduces the points with members to ensembles, and names the runs that did not end
/// well with their reasons on standard error. Each run's end is the one that was kept; a run without one was not run.
/// @param lock of the sweep's folder
/// @param command command line, which the provenance of the ensembles repeats
[[nodiscard]] Outcome gather(const SweepPlan& plan, const std::filesystem::path& folder, const RunLock& lock,
                             const std::string& command);

}  // namespace voussoir::host
