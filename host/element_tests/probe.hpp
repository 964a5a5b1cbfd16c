#pragma once
/// `kind = "probe"`: the material law alone. A packing is taken along a path of increments and probed at the path's
/// end.

#include "host/case/case.hpp"
#include "host/process/exit_code.hpp"
#include "host/record/folder.hpp"

namespace voussoir::host {

/// Runs path and probes of each seed of `packing.seeds`, or of the packing that the case chooses. Writes probe.csv to
/// the run's folder and, where there is a path, path.csv and end_SEED.h5, the state at the path's end. Prints the
/// probes of the first packing to standard output.
[[nodiscard]] Outcome run_probe(const Case& input, const RunOptions& options);

}  // namespace voussoir::host
