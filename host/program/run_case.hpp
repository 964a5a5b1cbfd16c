#pragma once
/// The way from a case to its results: chooses the function that runs the kind of the case.

#include "host/case/case.hpp"
#include "host/process/exit_code.hpp"
#include "host/record/folder.hpp"

namespace voussoir::host {

/// Runs the case in options.folder (already checked by check_folder, and locked). Needs an initialised Kokkos. Throws
/// io::InputError where the run itself finds the input to be wrong, NoEquilibrium where a packing comes to no rest.
[[nodiscard]] Outcome run_case(const Case& input, const RunOptions& options);

}  // namespace voussoir::host
