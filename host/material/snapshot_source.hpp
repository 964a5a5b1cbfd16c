#pragma once
/// A material whose points can be drawn grain by grain. A batch that has grains implements this interface besides
/// fem::MaterialBatch.

#include <cstdint>
#include <span>
#include <vector>

#include "io/result_file.hpp"

namespace voussoir::host {

class SnapshotSource {
 public:
  virtual ~SnapshotSource() = default;
  /// The committed RVEs of these Gauss points, in full. Throws std::out_of_range on a point that does not exist.
  [[nodiscard]] virtual std::vector<io::RveSnapshot> snapshots(std::span<const std::int64_t> points) const = 0;
};

}  // namespace voussoir::host
