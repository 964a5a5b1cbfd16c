#pragma once
/// The way from a case to its results: chooses the function that runs the kind of the case, and the exit code.

#include "host/case/case.hpp"
#include "host/record/folder.hpp"

namespace voussoir::host {

/// Runs the case in options.folder (already checked by check_folder) and returns an exit code of exit_code.hpp. Needs
/// an initialised Kokkos. Throws io::InputError where the run itself finds the input
/// to be wrong.
[[nodiscard]] int run_case(const Case& input, const RunOptions& options);

}  // namespace voussoir::host
