#pragma once
/// The case kind "tunnel": a tunnel that loses volume, in the stages column, gravity and volume loss.

#include "fem/mesh.hpp"
#include "host/case/case.hpp"
#include "host/record/folder.hpp"
#include "host/stages/stage.hpp"

namespace voussoir::host {

/// The half domain of the case. Throws std::invalid_argument where its sizes make no mesh.
[[nodiscard]] fem::Mesh tunnel_mesh(const GroundCase& soil);

/// Starts the tunnel of the case in options.folder, or goes on with it. The column has its results in the folder
/// `column` there.
[[nodiscard]] RunStatus run_tunnel(const Case& input, const RunOptions& options);

}  // namespace voussoir::host
