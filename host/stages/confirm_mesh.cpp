#include "host/stages/confirm_mesh.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "io/input_error.hpp"
#include "io/result_file.hpp"

namespace voussoir::host {

void confirm_mesh(const io::MeshData& mesh, const RunOptions& options, const std::string& key) {
  const std::filesystem::path index = options.folder / "run.h5";
  if (!options.resume || !std::filesystem::exists(index)) return;
  io::MeshData theirs;
  try {
    theirs = io::read_mesh(index);
  } catch (const std::runtime_error&) {
    return;  // the index is damaged; the run makes it anew
  }
  double size = 0;
  for (const double x : mesh.coordinates) size = std::max(size, std::abs(x));
  const auto close = [size](double a, double b) { return std::abs(a - b) <= 1e-9 * size; };
  const bool same = theirs.connectivity == mesh.connectivity &&
                    std::equal(theirs.coordinates.begin(), theirs.coordinates.end(), mesh.coordinates.begin(),
                               mesh.coordinates.end(), close);
  if (same) return;
  throw io::InputError("--resume", options.folder.string(),
                       fmt::format("was begun on another mesh, of {} elements and not {}: it needs the file of "
                                   "{}, or the version of Gmsh, that made its mesh",
                                   theirs.elements(), mesh.elements(), key));
}

}  // namespace voussoir::host
