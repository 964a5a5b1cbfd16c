#pragma once
/// From a case file to a case: every table is read by the file of this folder that knows it, and values of different
/// tables are held against each other.

#include <filesystem>
#include <string>
#include <vector>

#include "host/case/case.hpp"

namespace voussoir::host {

/// Reads, overrides (`table.key=value`) and validates a case. Throws io::InputError (file, line, key) on anything
/// wrong: unknown keys, wrong units, values outside their limits, values that do not fit together.
[[nodiscard]] Case load_case(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

}  // namespace voussoir::host
