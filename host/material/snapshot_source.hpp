#pragma once
/// A material that can show its points grain by grain. A batch with grains implements this interface in addition to
/// fem::MaterialBatch.

#include <cstdint>
#include <span>
#include <vector>

#include "io/result_file.hpp"

namespace voussoir::host {

class SnapshotSource {
 public:
  virtual ~SnapshotSource() = default;
  /// The committed RVEs of these Gauss points with all grains and contacts. Throws std::out_of_range where a point does
  /// not exist.
  [[nodiscard]] virtual std::vector<io::RveSnapshot> snapshots(std::span<const std::int64_t> points) const = 0;
};

}  // namespace voussoir::host
