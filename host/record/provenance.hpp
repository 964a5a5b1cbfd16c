#pragma once
/// Where a result comes from: the case, the program and its build, the command, the date, threads and ranks.

#include <string>

#include "host/case/case.hpp"
#include "host/record/folder.hpp"
#include "io/result_file.hpp"

namespace voussoir::host {

/// @param kind names the kind of results, e.g. "column" for the column of a tunnel
[[nodiscard]] io::Provenance provenance_of(const RunOptions& options, const Case& input, const std::string& kind);

}  // namespace voussoir::host
