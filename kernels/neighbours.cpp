#include "kernels/neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernels/rve_batch.hpp"

namespace voussoir::kernels {

namespace {

/// Grains of one size level (radii within a factor 2) sorted into bins of the fractional cell by counting sort. A bin is as
/// wide as the level's largest grain plus skin, so that whoever meets a member from outside or inside the level, being no
/// larger, finds it within one bin. Members stand in the order of the bins: neighbours are runs of them.
struct Level {
  int nx = 1, ny = 1;
  std::vector<int> start, member;
  std::vector<double> x, y, radius;  ///< of the members

  Level(std::span<const double> positions, std::span<const double> radii, const std::vector<int>& grains, const Cell& cell,
        double largest, double skin)
      : member(grains.size()), x(grains.size()), y(grains.size()), radius(grains.size()) {
    const double width = 2.0 * largest + skin;
    const double most = std::ceil(std::sqrt(static_cast<double>(grains.size()))) + 1.0;  // more bins than grains find nothing
    nx = static_cast<int>(std::clamp(cell.height(0) / width, 1.0, most));
    ny = static_cast<int>(std::clamp(cell.height(1) / width, 1.0, most));
    start.assign(static_cast<std::size_t>(nx * ny) + 1, 0);
    std::vector<std::size_t> bins;
    for (const int i : grains) {
      const auto si = static_cast<std::size_t>(i);
      const auto [a, b] = slots(cell, positions[2 * si], positions[2 * si + 1]);
      bins.push_back(static_cast<std::size_t>(a + nx * b));
      ++start[bins.back() + 1];
    }
    for (std::size_t b = 1; b < start.size(); ++b) start[b] += start[b - 1];
    std::vector<int> next(start.begin(), start.end() - 1);
    for (std::size_t k = 0; k < grains.size(); ++k) {
      const auto at = static_cast<std::size_t>(next[bins[k]]++), i = static_cast<std::size_t>(grains[k]);
      member[at] = grains[k];
      x[at] = positions[2 * i];
      y[at] = positions[2 * i + 1];
      radius[at] = radii[i];
    }
  }

  [[nodiscard]] std::pair<int, int> slots(const Cell& cell, double px, double py) const {
    return {slot(cell.inverse.xx * px + cell.inverse.xy * py, nx), slot(cell.inverse.yx * px + cell.inverse.yy * py, ny)};
  }

  static int slot(double fraction, int n) {
    const double inside = fraction - std::floor(fraction);
    return std::min(n - 1, static_cast<int>(inside * n));
  }
};

/// The bins within one step along a periodic axis, each once, as at most two ranges first .. last.
int ranges_along(int at, int n, std::pair<int, int> out[2]) {
  out[0] = {std::max(at - 1, 0), std::min(at + 1, n - 1)};
  if (n < 3 || (at > 0 && at < n - 1)) return 1;
  out[1] = at == 0 ? std::pair{n - 1, n - 1} : std::pair{0, 0};
  return 2;
}

/// Levels of radii, the largest first; a grain of radius r belongs to level floor(log2(r_max / r)).
std::vector<std::vector<int>> sort_by_size(std::span<const double> radii, double largest) {
  std::vector<std::vector<int>> levels;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const auto level = static_cast<std::size_t>(std::max(0, std::ilogb(largest / radii[i])));
    if (level >= levels.size()) levels.resize(level + 1);
    levels[level].push_back(static_cast<int>(i));
  }
  return levels;
}

/// Calls `meet(first, last)` for every run of members in the bins around a point.
template <class Meet>
void visit(const Level& level, const Cell& cell, double x, double y, const Meet& meet) {
  const auto [a, b] = level.slots(cell, x, y);
  std::pair<int, int> across[2], up[2];
  const int n_across = ranges_along(a, level.nx, across);
  const int n_up = ranges_along(b, level.ny, up);
  for (int u = 0; u < n_up; ++u) {
    for (int row = up[u].first; row <= up[u].second; ++row) {
      for (int v = 0; v < n_across; ++v) {
        const auto bin = static_cast<std::size_t>(level.nx * row);
        meet(level.start[bin + static_cast<std::size_t>(across[v].first)],
             level.start[bin + static_cast<std::size_t>(across[v].second) + 1]);
      }
    }
  }
}

/// Appends the keys of member k of `own` with those of `level`'s members first .. last - 1 that are within reach; without a
/// branch, which would be mispredicted as often as not.
void append_near(const Level& own, std::size_t k, const Level& level, int first, int last, const Cell& cell, double skin,
                 std::vector<std::uint32_t>& keys, std::size_t& count) {
  if (first >= last) return;
  const std::size_t most = count + static_cast<std::size_t>(last - first);
  if (most > keys.size()) keys.resize(2 * most);
  const int i = own.member[k];
  for (auto m = static_cast<std::size_t>(first); m < static_cast<std::size_t>(last); ++m) {
    const double reach = own.radius[k] + level.radius[m] + skin;
    const int j = level.member[m];
    keys[count] = pair_key(std::min(i, j), std::max(i, j));
    count += is_within(reach, level.x[m] - own.x[k], level.y[m] - own.y[k], cell) ? 1 : 0;
  }
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
    levels.emplace_back(positions, radii, sorted[n], cell, std::ldexp(largest, -static_cast<int>(n)), skin);
    const Level& own = levels.back();
    for (std::size_t k = 0; k < own.member.size(); ++k) {
      for (const Level& level : levels) {  // its own level, whose later members it meets, and all coarser ones
        const int earliest = &level == &own ? static_cast<int>(k) + 1 : 0;
        visit(level, cell, own.x[k], own.y[k], [&](int first, int last) {
          append_near(own, k, level, std::max(first, earliest), last, cell, skin, keys, count);
        });
      }
    }
  }
  keys.resize(count);
  std::sort(keys.begin(), keys.end());
}

}  // namespace voussoir::kernels
