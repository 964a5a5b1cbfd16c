#pragma once
/// A tunnel that loses volume, as a scene.

#include "host/scene/scene.hpp"

namespace voussoir::host {

/// The scene of [ground], [gravity] and [volume_loss]: the base is fixed, sides and axis are on rollers; in the stage
/// "gravity" the tractions of ground at rest hold the opening, in the stage "volume_loss" the opening shrinks about its
/// invert, and V_l is the load parameter.
[[nodiscard]] Scene tunnel_scene(const Case& input, fem::Mesh mesh);

}  // namespace voussoir::host
