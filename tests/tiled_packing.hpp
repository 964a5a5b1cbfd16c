#pragma once
/// Large packings at rest, made quickly: copies of a small one, side by side.

#include <utility>

#include "tests/reference/reference_packing.hpp"

namespace voussoir::reference {

/// `columns` by `rows` copies of a packing, which make one cell.
[[nodiscard]] inline Rve tiled(const Rve& tile, int columns, int rows) {
  const int grains = static_cast<int>(tile.radii.size());
  const Mat2 inverse = reference::inverse(tile.cell);
  Rve out = tile;
  out.cell = {columns * tile.cell.xx, rows * tile.cell.xy, columns * tile.cell.yx, rows * tile.cell.yy};
  out.positions.clear();
  out.radii.clear();
  out.rotations.clear();
  out.histories.clear();
  const auto wrapped = [&](int i) {
    const Vec2 f = inverse * tile.positions[static_cast<std::size_t>(i)];
    return Vec2{f.x - std::floor(f.x), f.y - std::floor(f.y)};
  };
  for (int t = 0; t < columns * rows; ++t) {
    const int column = t % columns, row = t / columns;
    for (int i = 0; i < grains; ++i) {
      const Vec2 f = wrapped(i);
      out.positions.push_back(tile.cell * Vec2{f.x + column, f.y + row});
      out.radii.push_back(tile.radii[static_cast<std::size_t>(i)]);
      out.rotations.push_back(0.0);
    }
    for (const auto& [pair, history] : tile.histories) {
      const Vec2 a = wrapped(pair.first), b = wrapped(pair.second);
      // The nearest image of the second grain is in a neighbouring tile where the pair lies across the border.
      const int right = static_cast<int>(std::lround(a.x - b.x)), up = static_cast<int>(std::lround(a.y - b.y));
      const int other = (column + right + columns) % columns + columns * ((row + up + rows) % rows);
      const int i = t * grains + pair.first, j = other * grains + pair.second;
      // The moment on the first grain is minus that on the second one.
      if (i < j) out.histories[{i, j}] = history;
      if (j < i) out.histories[{j, i}] = {history.tangential, -history.moment};
    }
  }
  return out;
}

}  // namespace voussoir::reference
