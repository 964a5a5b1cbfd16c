#pragma once
/// `kind = "probe"`: the material law alone. A packing is taken along a path of increments and probed at its end.

#include "host/case/case.hpp"
#include "host/record/folder.hpp"

namespace voussoir::host {

/// Path and probes of every seed (of `packing.seeds`, else of the packing the case chooses). Writes to the run's folder
/// path.csv and end_SEED.h5, the state at the path's end (where there is a path), and probe.csv; the first packing's
/// probes also to standard output. Returns an exit code.
[[nodiscard]] int run_probe(const Case& input, const RunOptions& options);

}  // namespace voussoir::host
