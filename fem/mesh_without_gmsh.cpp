/// The generator and the reader of a program that is built without Gmsh.

#include <stdexcept>

#include "fem/mesh_gmsh.hpp"
#include "fem/mesh_gmsh_file.hpp"

namespace voussoir::fem {

QuadMesh generate_quads(const HalfTunnelOptions& /*options*/) {
  throw std::runtime_error(
      "this program was built without Gmsh, which generates meshes; it runs on a stored one, which ground.mesh_file "
      "names");
}

GmshFile read_gmsh_file(const std::filesystem::path& /*path*/, double /*seconds*/) {
  throw std::runtime_error(
      "this program was built without Gmsh, which reads mesh files; it makes the shapes grid and ring itself");
}

}  // namespace voussoir::fem
