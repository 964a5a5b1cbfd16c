#include "kernels/neighbours.hpp"

#include <algorithm>
#include <cmath>

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

double Cell::height(int axis) const {
  const double row = axis == 0 ? std::hypot(inverse.xx, inverse.xy) : std::hypot(inverse.yx, inverse.yy);
  return 1.0 / row;
}

namespace {

/// Grains sorted into bins of the fractional cell, by counting sort; within a bin ascending by index.
struct Bins {
  int nx = 1, ny = 1;
  std::vector<int> start, member, bin_of;

  Bins(std::span<const double> positions, const Cell& cell, double cutoff) {
    const auto bins_along = [&](int axis) { return std::max(1, static_cast<int>(cell.height(axis) / cutoff)); };
    nx = bins_along(0);
    ny = bins_along(1);
    const std::size_t n = positions.size() / 2;
    bin_of.resize(n);
    start.assign(static_cast<std::size_t>(nx * ny) + 1, 0);
    for (std::size_t i = 0; i < n; ++i) {
      const double x = positions[2 * i], y = positions[2 * i + 1];
      bin_of[i] = slot(cell.inverse.xx * x + cell.inverse.xy * y, nx) +
                  nx * slot(cell.inverse.yx * x + cell.inverse.yy * y, ny);
      ++start[static_cast<std::size_t>(bin_of[i]) + 1];
    }
    for (std::size_t b = 1; b < start.size(); ++b) start[b] += start[b - 1];
    member.resize(n);
    std::vector<int> next(start.begin(), start.end() - 1);
    for (std::size_t i = 0; i < n; ++i) member[static_cast<std::size_t>(next[static_cast<std::size_t>(bin_of[i])]++)] = static_cast<int>(i);
  }

  static int slot(double fraction, int n) {
    const double inside = fraction - std::floor(fraction);
    return std::min(n - 1, static_cast<int>(inside * n));
  }
};

/// The bins within one step along an axis, each once, also when there are fewer than three.
int neighbours_along(int at, int n, int out[3]) {
  if (n == 1) {
    out[0] = 0;
    return 1;
  }
  out[0] = at;
  out[1] = (at + 1) % n;
  if (n == 2) return 2;
  out[2] = (at + n - 1) % n;
  return 3;
}

}  // namespace

void find_candidates(std::span<const double> positions, std::span<const double> radii, const Cell& cell, double skin,
                     std::vector<std::uint32_t>& keys) {
  keys.clear();
  const int n = static_cast<int>(radii.size());
  const double largest = *std::max_element(radii.begin(), radii.end());
  const Bins bins(positions, cell, 2.0 * largest + skin);
  for (int i = 0; i < n; ++i) {
    const std::size_t row_begin = keys.size();
    const auto si = static_cast<std::size_t>(i);
    int across[3], up[3];
    const int n_across = neighbours_along(bins.bin_of[si] % bins.nx, bins.nx, across);
    const int n_up = neighbours_along(bins.bin_of[si] / bins.nx, bins.ny, up);
    for (int b = 0; b < n_up; ++b) {
      for (int a = 0; a < n_across; ++a) {
        const auto bin = static_cast<std::size_t>(across[a] + bins.nx * up[b]);
        for (int m = bins.start[bin]; m < bins.start[bin + 1]; ++m) {
          const int j = bins.member[static_cast<std::size_t>(m)];
          if (j <= i) continue;
          const auto sj = static_cast<std::size_t>(j);
          double dx = positions[2 * sj] - positions[2 * si];
          double dy = positions[2 * sj + 1] - positions[2 * si + 1];
          cell.nearest(dx, dy);
          const double reach = radii[si] + radii[sj] + skin;
          if (dx * dx + dy * dy < reach * reach) keys.push_back(pair_key(i, j));
        }
      }
    }
    std::sort(keys.begin() + static_cast<std::ptrdiff_t>(row_begin), keys.end());
  }
}

}  // namespace voussoir::kernels
