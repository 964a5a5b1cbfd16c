#include "fem/mesh_gmsh_session.hpp"

#include <gmsh.h>
#include <omp.h>

namespace voussoir::fem {

GmshSession::GmshSession() : threads_before_(omp_get_max_threads()) {
  gmsh::initialize(0, nullptr, false);  // false: without the user's own option files
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::option::setNumber("General.NumThreads", 1);
  gmsh::model::add("voussoir");
}

GmshSession::~GmshSession() {
  gmsh::finalize();
  omp_set_num_threads(threads_before_);
}

}  // namespace voussoir::fem
