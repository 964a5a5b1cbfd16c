#pragma once
/// The case kind "scene": the stages of a scene, one after the other.

#include "host/case/case.hpp"
#include "host/record/folder.hpp"
#include "host/stages/stage.hpp"

namespace voussoir::host {

/// Starts the scene of the case in options.folder, or goes on with it.
[[nodiscard]] RunStatus run_scene(const Case& input, const RunOptions& options);

}  // namespace voussoir::host
