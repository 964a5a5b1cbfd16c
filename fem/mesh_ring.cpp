#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "fem/gauss_points.hpp"
#include "fem/mesh_builder.hpp"
#include "fem/mesh_grid.hpp"

namespace voussoir::fem {

namespace {

void require(bool holds, const char* sentence) {
  if (!holds) throw std::invalid_argument(sentence);
}

void check(const RingOptions& o) {
  require(std::isfinite(o.radius) && o.radius > 0, "radius: it must be positive and finite");
  require(std::isfinite(o.outer) && o.outer > o.radius, "outer: it must be larger than the radius and finite");
  require(o.quarters == 1 || o.quarters == 2 || o.quarters == 4, "part: a ring is a quarter, half or whole");
  require(o.columns >= o.quarters, "columns: at least one element in each quarter is needed");
  require(o.rows >= 1, "rows: at least one element is needed");
  require(static_cast<double>(o.columns) * static_cast<double>(o.rows) <= max_elements,
          "rows: the ring would have more than two million elements");
  require(std::isfinite(o.ratio) && o.ratio >= 0.01 && o.ratio <= 100,
          "ratio: a ratio of lengths must be between 0.01 and 100");
}

/// The unit vector at an angle in quarters of a turn from the x axis; on the axes it is exact.
Point direction(double quarters) {
  const double whole = std::floor(quarters);
  const double angle = (quarters - whole) * std::numbers::pi / 2;
  Point d(angle == 0 ? 1 : std::cos(angle), angle == 0 ? 0 : std::sin(angle));
  for (int k = 0; k < (static_cast<int>(whole) + 4) % 4; ++k) d = Point(-d.y(), d.x());
  return d;
}

/// Column c of the ring starts at this angle, in quarters of a turn; half a ring is the one to the right of x = 0.
double angle_of(const RingOptions& o, double c) {
  const double start = o.quarters == 2 ? -1 : 0;
  return start + c * o.quarters / static_cast<double>(o.columns);
}

QuadMesh quads_of(const RingOptions& o, int around) {
  const int columns = static_cast<int>(o.columns);
  const int rows = static_cast<int>(o.rows);
  const std::vector<double> radii = graded_line(o.radius, o.outer, o.rows, o.ratio);
  QuadMesh mesh;
  mesh.corners.resize(2, around * (rows + 1));
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i < around; ++i) mesh.corners.col(j * around + i) = radii[j] * direction(angle_of(o, i));
    for (int i = 0; i < columns; ++i)
      mesh.midsides[corner_pair(j * around + i, j * around + (i + 1) % around)] = radii[j] *
                                                                                  direction(angle_of(o, i + 0.5));
  }
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int first = j * around + i;
      const int second = j * around + (i + 1) % around;
      mesh.quads.push_back({first, first + around, second + around, second});
    }
  return mesh;
}

}  // namespace

Mesh make_ring(const RingOptions& o) {
  check(o);
  const int around = static_cast<int>(o.columns) + (o.quarters == 4 ? 0 : 1);  // corners on a circle
  Mesh mesh = complete_q8(quads_of(o, around), [&](int a, int b) -> std::string {
    if (a / around == b / around) return a / around == 0 ? "cavity" : "far";
    return o.quarters == 1 && a % around == 0 ? "y0" : "x0";
  });
  if (!(gauss_points(mesh, mesh.coordinates).smallest_jacobian > 0))
    throw std::invalid_argument("ratio: an element is folded or has no length; take a smaller ratio or fewer rows");
  return mesh;
}

}  // namespace voussoir::fem
