#pragma once
/// `kind = "biaxial"`: drained biaxial tests of the packings of a case.

#include "host/case/case.hpp"
#include "host/process/exit_code.hpp"
#include "host/record/folder.hpp"

namespace voussoir::host {

/// Writes curves and strength to run.h5:/tables and a summary to standard output.
[[nodiscard]] Outcome run_biaxial(const Case& input, const RunOptions& options);

}  // namespace voussoir::host
