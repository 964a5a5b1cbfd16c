#pragma once
/// Generated meshes on disk, so that a program without a generator can run on them, and no other generator's version
/// changes a result.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace voussoir::io {

/// A mesh of quadrilaterals as its generator made it: midside nodes and boundaries follow from it. What the mesh was
/// made for stands beside it under the names of the case's keys.
struct StoredMesh {
  std::vector<double> corners = {};                ///< (node, 2) [m]
  std::vector<std::int64_t> quads = {};            ///< (element, 4), counter-clockwise, counted from 0
  std::map<std::string, double> numbers = {};      ///< width, height [m], ... (SI)
  std::map<std::string, std::string> labels = {};  ///< shape, made_by

  [[nodiscard]] std::size_t nodes() const { return corners.size() / 2; }
  [[nodiscard]] std::size_t elements() const { return quads.size() / 4; }
};

/// Writes an HDF5 file (docs/reference/files.md) through a temporary name. Throws std::invalid_argument where the mesh
/// is none, std::runtime_error where the file cannot be written.
void save_mesh(const std::filesystem::path& path, const StoredMesh& mesh);

/// Reads a file of save_mesh. Throws std::runtime_error where the file is missing, damaged or no mesh, where its
/// numbers were changed, or where they make no mesh: sizes that disagree, nodes of no element, elements without area.
[[nodiscard]] StoredMesh load_mesh(const std::filesystem::path& path);

}  // namespace voussoir::io
