#pragma once
/// A run goes on only on the mesh of its start.

#include "host/record/folder.hpp"
#include "io/result_data.hpp"

namespace voussoir::host {

/// Compares the mesh with that of the run in options.folder, where the run is to go on. `key` names the file that made
/// the mesh. @throws io::InputError where they differ; a generated mesh may be from another version of Gmsh.
void confirm_mesh(const io::MeshData& mesh, const RunOptions& options, const std::string& key);

}  // namespace voussoir::host
