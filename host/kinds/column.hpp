#pragma once
/// The case kind "column": the column of ground that measures K0 (sigma_yy), as a run of its own.

#include "host/scene/k0_column.hpp"

namespace voussoir::host {

/// Starts the column in options.folder, or goes on with it.
[[nodiscard]] RunStatus run_column(const Case& input, const RunOptions& options);

}  // namespace voussoir::host
