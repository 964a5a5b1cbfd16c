#pragma once
/// The case kind "tunnel": a tunnel that loses volume. Column, gravity, volume loss (method.md, section 4).

#include "fem/mesh.hpp"
#include "host/case/case.hpp"
#include "host/record/folder.hpp"
#include "host/stages/stage.hpp"

namespace voussoir::host {

/// The half domain of the case. Throws std::invalid_argument where its sizes make no mesh.
[[nodiscard]] fem::Mesh tunnel_mesh(const GroundCase& soil);

/// Runs, or goes on with, the tunnel of the case in options.folder; the column's own results are in its folder
/// `column`.
[[nodiscard]] RunStatus run_tunnel(const Case& input, const RunOptions& options);

}  // namespace voussoir::host
