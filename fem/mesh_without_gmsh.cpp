/// The generator of a program that is built without Gmsh.

#include <stdexcept>

#include "fem/mesh_gmsh.hpp"

namespace voussoir::fem {

QuadMesh generate_quads(const HalfTunnelOptions& /*options*/) {
  throw std::runtime_error(
      "this program was built without Gmsh, which generates meshes; it runs on a stored one, which ground.mesh_file "
      "names");
}

}  // namespace voussoir::fem
