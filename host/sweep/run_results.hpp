#pragma once
/// What the table of a sweep says of one run: how far it came, what it cost, and its results, by its kind.

#include <filesystem>
#include <optional>

#include "host/ensemble/member.hpp"
#include "io/sweep_file.hpp"

namespace voussoir::host {

/// Sets stage, load parameter, cost and results of a row from the folder of its run. A run without a run.h5 leaves the
/// row as it is. Throws std::runtime_error where a file is damaged. Returns what it has read of
/// a run on a mesh, of which means over members can be made, so that nobody needs to read the run again.
///
/// Results of a run on a mesh are the further columns of its last increment, and for a tunnel the surface trough and
/// the ground reaction at its end (host/ensemble/member.hpp). Those of `biaxial` are the means over its packings of the
/// angles and strains of its valid tests, each with its standard error over the packings (`peak_angle_error`). Those of
/// `calibrate` are the row of its fit.
std::optional<MemberResults> add_results(io::SweepRow& row, const std::filesystem::path& folder);

}  // namespace voussoir::host
