#include "fem/mesh_rectangle.hpp"

#include <cmath>
#include <stdexcept>

#include "fem/mesh_builder.hpp"

namespace voussoir::fem {

Mesh make_rectangle(double width, double height, int nx, int ny) {
  if (!(width > 0) || !(height > 0) || !std::isfinite(width) || !std::isfinite(height))
    throw std::invalid_argument("rectangle mesh: width and height must be positive and finite");
  if (nx < 1 || ny < 1 || nx > 10000 || ny > 10000)
    throw std::invalid_argument("rectangle mesh: nx and ny must be between 1 and 10000");
  Coordinates corners(2, (nx + 1) * (ny + 1));
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i)
      corners.col(j * (nx + 1) + i) << (i == nx ? width : width * i / nx), (j == ny ? height : height * j / ny);
  std::vector<Quad> quads;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const int first = j * (nx + 1) + i;
      quads.push_back({first, first + 1, first + nx + 2, first + nx + 1});
    }
  return complete_q8(corners, quads,
                     [&](const Point& a, const Point& b) { return place_on_block(a, b, width, height); });
}

}  // namespace voussoir::fem
