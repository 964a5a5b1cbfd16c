#pragma once
/// From a case to its results: the function that runs its kind, and the exit code.

#include "host/case/case.hpp"
#include "host/record/folder.hpp"

namespace voussoir::host {

/// Runs the case in options.folder (already checked by check_folder) and returns an exit code of exit_code.hpp. Needs
/// an initialised Kokkos. Throws io::InputError where the run itself finds the input
/// to be wrong.
[[nodiscard]] int run_case(const Case& input, const RunOptions& options);

}  // namespace voussoir::host
