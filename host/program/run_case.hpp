#pragma once
/// From a case to its results: the choice by kind, and the answer to whoever waits.

#include "host/case/case.hpp"
#include "host/record/folder.hpp"

namespace voussoir::host {

/// Runs the case in options.folder (already checked by check_folder) and returns an exit code of exit_code.hpp. Needs
/// an initialised Kokkos. Throws io::InputError on input that shows itself to be wrong only here.
[[nodiscard]] int run_case(const Case& input, const RunOptions& options);

}  // namespace voussoir::host
