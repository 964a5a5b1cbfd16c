#include "host/scene/scene_mesh.hpp"

#include <stdexcept>

namespace voussoir::host {

fem::Mesh scene_mesh(const SceneMeshCase& /*mesh*/) { throw std::logic_error("scenes have no mesh yet"); }

}  // namespace voussoir::host
