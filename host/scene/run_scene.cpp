#include "host/scene/run_scene.hpp"

#include <stdexcept>

namespace voussoir::host {

RunStatus run_scene(const Case& /*input*/, const RunOptions& /*options*/) {
  throw std::logic_error("scenes do not run yet");
}

}  // namespace voussoir::host
