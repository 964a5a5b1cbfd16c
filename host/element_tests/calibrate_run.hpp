#pragma once
/// `kind = "calibrate"`: the search of the grains' open parameters for a given strength.

#include "host/case/case.hpp"
#include "host/process/exit_code.hpp"
#include "host/record/folder.hpp"

namespace voussoir::host {

/// Tests the grid, refines around its optimum and confirms the optimum. Writes the tables `search`, `fit`, `tests` and
/// `sensitivity` of run.h5 and a summary to standard output.
[[nodiscard]] Outcome run_calibrate(const Case& input, const RunOptions& options);

}  // namespace voussoir::host
