#include "host/process/resources.hpp"

#include <sys/resource.h>

namespace voussoir::host {

double peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

}  // namespace voussoir::host
