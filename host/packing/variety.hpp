#pragma once
/// Which packing each Gauss point holds. Where all points hold clones of one packing, the draw of this packing decides
/// the result; several packings, mixed over the points, average over the draw.

#include <cstdint>
#include <vector>

#include "host/packing/packed_rve.hpp"

namespace voussoir::host {

/// The packings of a mesh, and the packing that each Gauss point holds.
struct PackingMix {
  std::vector<PackedRve> packings;
  std::vector<int> of_point;              ///< (point) index into `packings`
  std::vector<std::size_t> numbers = {};  ///< (point) of the mesh, for messages; empty: all points of a mesh, in order

  [[nodiscard]] std::size_t points() const { return of_point.size(); }
  /// The mix of some of the points, in their order; all packings stay, so that their indices keep their meaning.
  [[nodiscard]] PackingMix part(const std::vector<std::size_t>& points) const;
};

/// The cell area of each point below which its grains interpenetrate (law_range.hpp) [m^2].
[[nodiscard]] std::vector<double> least_areas(const PackingMix& mix);

/// Clones of one packing at `n` points.
[[nodiscard]] PackingMix clones_of(PackedRve rve, std::size_t n);

/// Spreads packings over `n` points: a random permutation of the points' numbers, which `seed` decides, deals the
/// packings out in turn, so that the numbers of points of two packings differ by one at most. The same seed gives the
/// same mix on every machine.
[[nodiscard]] PackingMix mix(std::vector<PackedRve> packings, std::size_t n, std::int64_t seed);

/// One mix of several, whose points lie between one another in a mesh: point i of mix k is the point places[k][i] of
/// the joined mix. Mixes that have equal packings share them.
[[nodiscard]] PackingMix join(std::vector<PackingMix> mixes, const std::vector<std::vector<std::size_t>>& places);

}  // namespace voussoir::host
