#pragma once
/// The list of a sweep's runs with what each is expected to cost.

#include <filesystem>
#include <string>

#include "host/sweep/sweep_file.hpp"

namespace voussoir::host {

/// The runs as a table, or as JSON (io/run_list.hpp). Each case is accepted as `voussoir check` does it; throws
/// io::InputError with the run's place where one is not.
[[nodiscard]] std::string list_of(const SweepPlan& plan, const std::filesystem::path& folder, bool as_json);

}  // namespace voussoir::host
