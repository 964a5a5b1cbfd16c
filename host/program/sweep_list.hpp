#pragma once
/// The list of a sweep's runs with what each is expected to cost.

#include <filesystem>
#include <string>

#include "host/program/accept_case.hpp"
#include "host/sweep/sweep_file.hpp"

namespace voussoir::host {

/// The case of a run, accepted as `voussoir check` does it. Throws io::InputError with the run's place in the sweep
/// where it is not.
[[nodiscard]] AcceptedCase accept_run(const PlannedRun& run);

/// The runs as a table, or as JSON (io/run_list.hpp); throws what accept_run throws.
[[nodiscard]] std::string list_of(const SweepPlan& plan, const std::filesystem::path& folder, bool as_json);

}  // namespace voussoir::host
