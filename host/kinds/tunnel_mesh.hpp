#pragma once
/// The mesh of a tunnel's ground: generated, or read from a file that holds a generated one.

#include "fem/mesh.hpp"
#include "host/case/case.hpp"
#include "io/mesh_file.hpp"

namespace voussoir::host {

/// The half domain of the case. Throws io::InputError where its sizes make no mesh, std::runtime_error where the file
/// `mesh_file` cannot be used: its name and the fault, which may be that it was made for another ground.
[[nodiscard]] fem::Mesh tunnel_mesh(const GroundCase& soil);

/// The generated mesh of a ground without `mesh_file`, for such a file. Throws io::InputError as tunnel_mesh.
[[nodiscard]] io::StoredMesh mesh_to_store(const GroundCase& soil);

}  // namespace voussoir::host
