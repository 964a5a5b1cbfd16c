#pragma once
/// The estimates as text for the user who asks before a run.

#include <string>
#include <vector>

#include "host/case/case.hpp"
#include "host/estimate/case_size.hpp"

namespace voussoir::host {

/// A number of bytes for the user: "12 MB".
[[nodiscard]] std::string bytes_text(double bytes);

/// A warning where many lanes hold no RVE (share_of_lanes); else empty.
[[nodiscard]] std::string lanes_warning(const CaseSize& size);

/// @param place of the key output.rves. Throws io::InputError where output.rves names a point that the mesh does not
/// have.
void check_snapshot_points(const OutputCase& output, const CaseSize& size, const std::string& place);

/// Lines for `check`: points, increments, work, memory and disk.
[[nodiscard]] std::vector<std::string> describe(const CaseSize& size, MaterialKind material, const PackingCase& packing,
                                                const OutputCase& output);

}  // namespace voussoir::host
