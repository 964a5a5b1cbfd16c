#include "kernels/neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernels/rve_batch.hpp"

namespace voussoir::kernels {

void Cell::wrap(double& x, double& y) const {
  const double a = std::floor(inverse.xx * x + inverse.xy * y);
  const double b = std::floor(inverse.yx * x + inverse.yy * y);
  x -= h.xx * a + h.xy * b;
  y -= h.yx * a + h.yy * b;
}

void Cell::nearest(double& dx, double& dy) const {
  const double a = std::nearbyint(inverse.xx * dx + inverse.xy * dy);
  const double b = std::nearbyint(inverse.yx * dx + inverse.yy * dy);
  dx -= h.xx * a + h.xy * b;
  dy -= h.yx * a + h.yy * b;
}

Mat2 reduced_lattice(Mat2 cell) {
  constexpr int most_swaps = 1000;  // each but the last shortens a vector; a bound for cells that are no numbers
  for (int k = 0; k < most_swaps; ++k) {
    const double aa = cell.xx * cell.xx + cell.yx * cell.yx;
    const double bb = cell.xy * cell.xy + cell.yy * cell.yy;
    const double ab = cell.xx * cell.xy + cell.yx * cell.yy;
    if (aa <= bb) {
      const double n = std::nearbyint(ab / aa);
      if (n == 0 || !std::isfinite(n)) break;
      cell.xy -= n * cell.xx;
      cell.yy -= n * cell.yx;
    } else {
      const double n = std::nearbyint(ab / bb);
      if (n == 0 || !std::isfinite(n)) break;
      cell.xx -= n * cell.xy;
      cell.yx -= n * cell.yy;
    }
  }
  return cell;
}

bool wide_enough(const Cell& cell, double largest_radius, double skin) {
  return std::min(cell.height(0), cell.height(1)) > 2.0 * (2.0 * largest_radius + skin);
}

double Cell::height(int axis) const {
  const double row = axis == 0 ? std::hypot(inverse.xx, inverse.xy) : std::hypot(inverse.yx, inverse.yy);
  return 1.0 / row;
}

namespace {

/// Grains of one size level (radii within a factor 2) sorted into bins of the fractional cell by counting sort. A bin is as
/// wide as the level's largest grain plus skin, so that whoever meets a member from outside or inside the level, being no
/// larger, finds it within one bin.
struct Level {
  int nx = 1, ny = 1;
  std::vector<int> start, member;

  Level(std::span<const double> positions, const std::vector<int>& grains, const Cell& cell, double largest, double skin) {
    const double width = 2.0 * largest + skin;
    const double most = std::ceil(std::sqrt(static_cast<double>(grains.size()))) + 1.0;  // more bins than grains find nothing
    nx = static_cast<int>(std::clamp(cell.height(0) / width, 1.0, most));
    ny = static_cast<int>(std::clamp(cell.height(1) / width, 1.0, most));
    start.assign(static_cast<std::size_t>(nx * ny) + 1, 0);
    member.resize(grains.size());
    for (const int i : grains) ++start[bin_of(positions, cell, i) + 1];
    for (std::size_t b = 1; b < start.size(); ++b) start[b] += start[b - 1];
    std::vector<int> next(start.begin(), start.end() - 1);
    for (const int i : grains) member[static_cast<std::size_t>(next[bin_of(positions, cell, i)]++)] = i;
  }

  [[nodiscard]] std::size_t bin_of(std::span<const double> positions, const Cell& cell, int i) const {
    const auto [a, b] = slots(positions, cell, i);
    return static_cast<std::size_t>(a + nx * b);
  }

  [[nodiscard]] std::pair<int, int> slots(std::span<const double> positions, const Cell& cell, int i) const {
    const double x = positions[2 * static_cast<std::size_t>(i)], y = positions[2 * static_cast<std::size_t>(i) + 1];
    return {slot(cell.inverse.xx * x + cell.inverse.xy * y, nx), slot(cell.inverse.yx * x + cell.inverse.yy * y, ny)};
  }

  static int slot(double fraction, int n) {
    const double inside = fraction - std::floor(fraction);
    return std::min(n - 1, static_cast<int>(inside * n));
  }
};

/// The bins within one step along an axis, each once, also when there are fewer than three.
int neighbours_along(int at, int n, int out[3]) {
  out[0] = at;
  if (n == 1) return 1;
  out[1] = (at + 1) % n;
  if (n == 2) return 2;
  out[2] = (at + n - 1) % n;
  return 3;
}

/// Levels of radii, the largest first; a grain of radius r belongs to level floor(log2(r_max / r)).
std::vector<std::vector<int>> sort_by_size(std::span<const double> radii, double largest) {
  std::vector<std::vector<int>> levels;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const auto level = static_cast<std::size_t>(std::max(0.0, std::floor(std::log2(largest / radii[i]))));
    if (level >= levels.size()) levels.resize(level + 1);
    levels[level].push_back(static_cast<int>(i));
  }
  return levels;
}

/// Calls `meet(j)` for every member of the bins around grain i.
template <class Meet>
void visit(const Level& level, std::span<const double> positions, const Cell& cell, int i, const Meet& meet) {
  const auto [a, b] = level.slots(positions, cell, i);
  int across[3], up[3];
  const int n_across = neighbours_along(a, level.nx, across);
  const int n_up = neighbours_along(b, level.ny, up);
  for (int u = 0; u < n_up; ++u) {
    for (int v = 0; v < n_across; ++v) {
      const auto bin = static_cast<std::size_t>(across[v] + level.nx * up[u]);
      for (int m = level.start[bin]; m < level.start[bin + 1]; ++m) meet(level.member[static_cast<std::size_t>(m)]);
    }
  }
}

}  // namespace

void find_candidates(std::span<const double> positions, std::span<const double> radii, const Cell& cell, double skin,
                     std::vector<std::uint32_t>& keys) {
  keys.clear();
  const double largest = *std::max_element(radii.begin(), radii.end());
  const std::vector<std::vector<int>> sorted = sort_by_size(radii, largest);
  std::vector<Level> levels;
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    levels.emplace_back(positions, sorted[k], cell, std::ldexp(largest, -static_cast<int>(k)), skin);
    for (const int i : sorted[k]) {
      const auto si = static_cast<std::size_t>(i);
      const auto meet = [&](int j, bool same_level) {
        if (same_level && j <= i) return;
        const auto sj = static_cast<std::size_t>(j);
        double dx = positions[2 * sj] - positions[2 * si];
        double dy = positions[2 * sj + 1] - positions[2 * si + 1];
        cell.nearest(dx, dy);
        const double reach = radii[si] + radii[sj] + skin;
        if (dx * dx + dy * dy < reach * reach) keys.push_back(i < j ? pair_key(i, j) : pair_key(j, i));
      };
      for (std::size_t m = 0; m <= k; ++m) {  // its own level and all coarser ones
        visit(levels[m], positions, cell, i, [&](int j) { meet(j, m == k); });
      }
    }
  }
  std::sort(keys.begin(), keys.end());
}

}  // namespace voussoir::kernels
