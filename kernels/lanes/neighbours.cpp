#include "kernels/lanes/neighbours.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "kernels/lanes/wide_lane.hpp"
#include "kernels/state/rve_batch.hpp"

namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES {

namespace {

/// Several members are tested at once, one a lane. The arrays of members have as many spare entries at their end, so
/// that a load may go past the last member.
using Lanes = WideLane<double>;
constexpr std::size_t at_once = static_cast<std::size_t>(lane_count<Lanes>);

/// Grains of one size level (radii within a factor 2) sorted into bins of the fractional cell by counting sort. A bin
/// is at least as wide as the level's largest grain plus the skin, so that a grain which is no larger finds all members
/// near it in its own bin and the bins next to that. A frame of bins around the cell holds images of the members
/// inside, so that all neighbours of a point stand in three runs of members and the search need not know that the cell
/// is periodic. At least two bins fit across a cell that is wide enough.
struct Level {
  int nx = 2, ny = 2;
  std::vector<int> start;            ///< of each bin of (ny + 2) rows of (nx + 2)
  std::vector<int> member;           ///< grain, of an image too
  std::vector<double> x, y, radius;  ///< of the members

  Level(std::span<const double> positions, std::span<const double> radii, const std::vector<int>& grains,
        const Cell& cell, double largest, double skin) {
    const double width = 2.0 * largest + skin;
    // More bins than grains would only add empty bins.
    const double most = std::ceil(std::sqrt(static_cast<double>(grains.size()))) + 2.0;
    nx = static_cast<int>(std::clamp(cell.height(0) / width, 2.0, most));
    ny = static_cast<int>(std::clamp(cell.height(1) / width, 2.0, most));
    sort(images(positions, grains, cell), radii);
  }

  [[nodiscard]] std::size_t bin(int column, int row) const {
    // NOLINTNEXTLINE(bugprone-misplaced-widening-cast): the number of bins is near that of grains.
    return static_cast<std::size_t>((nx + 2) * (row + 1) + column + 1);
  }

  /// The bin of a point in the cell.
  [[nodiscard]] std::pair<int, int> slots(const Cell& cell, double px, double py) const {
    return {slot(cell.inverse.xx * px + cell.inverse.xy * py, nx),
            slot(cell.inverse.yx * px + cell.inverse.yy * py, ny)};
  }

 private:
  struct Image {
    int grain;
    std::size_t bin;
    double x, y;
  };

  static int slot(double fraction, int n) { return std::clamp(static_cast<int>(fraction * n), 0, n - 1); }

  [[nodiscard]] std::vector<Image> images(std::span<const double> positions, const std::vector<int>& grains,
                                          const Cell& cell) const {
    std::vector<Image> all;
    all.reserve(2 * grains.size());
    for (const int i : grains) {
      double px = positions[2 * static_cast<std::size_t>(i)], py = positions[2 * static_cast<std::size_t>(i) + 1];
      cell.wrap(px, py);
      const auto [a, b] = slots(cell, px, py);
      for (int v = b == ny - 1 ? -1 : 0; v <= (b == 0 ? 1 : 0); ++v) {
        for (int u = a == nx - 1 ? -1 : 0; u <= (a == 0 ? 1 : 0); ++u) {
          all.push_back(
              {i, bin(a + u * nx, b + v * ny), px + cell.h.xx * u + cell.h.xy * v, py + cell.h.yx * u + cell.h.yy * v});
        }
      }
    }
    return all;
  }

  void sort(const std::vector<Image>& images, std::span<const double> radii) {
    start.assign(static_cast<std::size_t>((nx + 2) * (ny + 2)) + 1, 0);
    for (const Image& image : images) ++start[image.bin + 1];
    for (std::size_t b = 1; b < start.size(); ++b) start[b] += start[b - 1];
    const std::size_t size = images.size() + at_once;
    member.resize(size, 0);
    x.resize(size, std::numeric_limits<double>::infinity());
    y.resize(size, 0.0);
    radius.resize(size, 0.0);
    std::vector<int> next(start.begin(), start.end() - 1);
    for (const Image& image : images) {
      const auto at = static_cast<std::size_t>(next[image.bin]++);
      member[at] = image.grain;
      x[at] = image.x;
      y[at] = image.y;
      radius[at] = radii[static_cast<std::size_t>(image.grain)];
    }
  }
};

/// Levels of radii, the largest first; a grain of radius r belongs to level floor(log2(r_max / r)).
std::vector<std::vector<int>> sort_by_size(std::span<const double> radii, double largest) {
  std::vector<std::vector<int>> levels;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    std::size_t level = 0;
    double diameter = 2.0 * radii[i];
    while (diameter <= largest) {
      diameter *= 2.0;
      ++level;
    }
    if (level >= levels.size()) levels.resize(level + 1);
    levels[level].push_back(static_cast<int>(i));
  }
  return levels;
}

/// Writes the keys of grain i and the members whose bits are set to `to`, which has room for all members. Returns their
/// number.
std::size_t append_keys(unsigned near, int i, const int* members, std::uint32_t* to) {
#if defined(VOUSSOIR_AVX512)  // without a branch, whose prediction would be wrong half of the time
  const __m256i own = _mm256_set1_epi32(i), other = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(members));
  const __m256i key = _mm256_or_si256(_mm256_slli_epi32(_mm256_min_epi32(own, other), 16),
                                      _mm256_max_epi32(own, other));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_maskz_compress_epi32(static_cast<__mmask8>(near), key));
  return static_cast<std::size_t>(std::popcount(near));
#else
  std::size_t count = 0;
  for (; near != 0; near &= near - 1) {
    const int j = members[std::countr_zero(near)];
    to[count++] = pair_key(std::min(i, j), std::max(i, j));
  }
  return count;
#endif
}

/// The grain whose neighbours are sought.
struct Seeker {
  int grain;
  double x, y, reach;  ///< inside the cell; own radius plus skin [m]
};

/// Appends the keys of a grain with `level`'s members first .. last - 1 that are within reach.
void append_near(const Seeker& one, const Level& level, int first, int last, std::vector<std::uint32_t>& keys,
                 std::size_t& count) {
  if (first >= last) return;
  const std::size_t most = count + static_cast<std::size_t>(last - first) + at_once;
  if (most > keys.size()) keys.resize(2 * most);
  const auto load = [](const double* from) {
    Lanes v;
    v.copy_from(from, Kokkos::Experimental::element_aligned_tag());
    return v;
  };
  const auto end = static_cast<std::size_t>(last);
  for (auto from = static_cast<std::size_t>(first); from < end; from += at_once) {
    const Lanes dx = load(&level.x[from]) - Lanes(one.x), dy = load(&level.y[from]) - Lanes(one.y);
    const Lanes reach = load(&level.radius[from]) + Lanes(one.reach);
    const unsigned near = bits_of(dx * dx + dy * dy < reach * reach) & ((1U << std::min(end - from, at_once)) - 1U);
    count += append_keys(near, one.grain, &level.member[from], &keys[count]);
  }
}

/// Appends the pairs within a level. Each member inside the cell is tested against the members after it in its bin, and
/// against those in the bins that follow.
void append_within(const Level& level, double skin, std::vector<std::uint32_t>& keys, std::size_t& count) {
  for (int row = 0; row < level.ny; ++row) {
    for (int column = 0; column < level.nx; ++column) {
      const int next = level.start[level.bin(column + 1, row) + 1];
      const int above = level.start[level.bin(column - 1, row + 1)],
                above_end = level.start[level.bin(column + 1, row + 1) + 1];
      for (int k = level.start[level.bin(column, row)]; k < level.start[level.bin(column, row) + 1]; ++k) {
        const auto at = static_cast<std::size_t>(k);
        const Seeker one{level.member[at], level.x[at], level.y[at], level.radius[at] + skin};
        append_near(one, level, k + 1, next, keys, count);
        append_near(one, level, above, above_end, keys, count);
      }
    }
  }
}

/// Appends the pairs of a level's members with the members of a coarser level.
void append_between(const Level& level, const Level& coarser, const Cell& cell, double skin,
                    std::vector<std::uint32_t>& keys, std::size_t& count) {
  for (int r = 0; r < level.ny; ++r) {
    for (int k = level.start[level.bin(0, r)]; k < level.start[level.bin(level.nx - 1, r) + 1]; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const Seeker one{level.member[at], level.x[at], level.y[at], level.radius[at] + skin};
      const auto [column, row] = coarser.slots(cell, one.x, one.y);
      for (int up = -1; up <= 1; ++up) {
        append_near(one, coarser, coarser.start[coarser.bin(column - 1, row + up)],
                    coarser.start[coarser.bin(column + 1, row + up) + 1], keys, count);
      }
    }
  }
}

/// Sorts keys in ascending order in two steps: all keys by their first grain (counting sort), then the few keys of one
/// grain by insertion.
void sort_keys(std::vector<std::uint32_t>& keys, std::size_t grains) {
  std::vector<std::uint32_t> sorted(keys.size());
  std::vector<std::size_t> next(grains + 1, 0);
  for (const std::uint32_t key : keys) ++next[static_cast<std::size_t>(first_of(key)) + 1];
  for (std::size_t i = 1; i <= grains; ++i) next[i] += next[i - 1];
  std::vector<std::size_t> row(next.begin(), next.end() - 1);
  for (const std::uint32_t key : keys) {
    const auto i = static_cast<std::size_t>(first_of(key));
    std::size_t at = next[i]++;
    for (; at > row[i] && sorted[at - 1] > key; --at) sorted[at] = sorted[at - 1];
    sorted[at] = key;
  }
  keys.swap(sorted);
}

}  // namespace

void find_candidates(std::span<const double> positions, std::span<const double> radii, const Cell& cell, double skin,
                     std::vector<std::uint32_t>& keys) {
  keys.resize(std::max(keys.size(), 4 * radii.size()));
  std::size_t count = 0;
  const double largest = *std::max_element(radii.begin(), radii.end());
  const std::vector<std::vector<int>> sorted = sort_by_size(radii, largest);
  std::vector<Level> levels;
  for (std::size_t n = 0; n < sorted.size(); ++n) {
    if (sorted[n].empty()) continue;
    Level own(positions, radii, sorted[n], cell, std::ldexp(largest, -static_cast<int>(n)), skin);
    append_within(own, skin, keys, count);
    for (const Level& coarser : levels) append_between(own, coarser, cell, skin, keys, count);
    levels.push_back(std::move(own));
  }
  keys.resize(count);
  sort_keys(keys, radii.size());
}

}  // namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES
