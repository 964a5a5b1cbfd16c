#pragma once
/// A scene in sentences, for `voussoir check`.

#include <string>
#include <vector>

#include "host/scene/scene_of.hpp"

namespace voussoir::host {

/// Mesh, boundaries, regions, the pressure at the start, stages with what is held, moved, pressed, released and dug
/// out, and the nodes at which the owner rule decides. `input` is the case that the scene was planned from.
[[nodiscard]] std::vector<std::string> describe(const Case& input, const PlannedScene& planned);

}  // namespace voussoir::host
