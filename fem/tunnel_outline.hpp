#pragma once
/// The outline of half of the ground around a circular tunnel: a rectangle less half a circle on its left edge. Lines
/// between layers may cross it.

#include <vector>

#include "fem/mesh.hpp"

namespace voussoir::fem {

struct HalfTunnelOptions {
  double width = 35.0;     ///< of the half domain [m]
  double height = 35.0;    ///< [m]
  double diameter = 5.0;   ///< D of the circular opening [m]
  double cover = 10.0;     ///< C, from the crown to the top [m]; the invert is at y = height - C - D
  double size_near = 0.5;  ///< element edge at the opening [m]; edges between crown and surface are 1.5 times as long
  double size_far = 2.5;   ///< largest element edge [m]
  std::vector<double> interfaces = {};  ///< heights of mesh lines between layers, ascending; also through the opening
                                        ///< [m]
};

struct Circle {
  Point centre;
  double radius;
  [[nodiscard]] Point project(const Point& x) const { return centre + radius * (x - centre).normalized(); }
};

[[nodiscard]] inline Circle opening_of(const HalfTunnelOptions& o) {
  const double invert_y = o.height - o.cover - o.diameter;
  return {{0, invert_y + o.diameter / 2}, o.diameter / 2};
}

}  // namespace voussoir::fem
