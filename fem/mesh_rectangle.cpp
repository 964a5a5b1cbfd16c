#include "fem/mesh_rectangle.hpp"

#include <cmath>
#include <stdexcept>

#include "fem/mesh_grid.hpp"

namespace voussoir::fem {

Mesh make_rectangle(double width, double height, int nx, int ny) {
  if (!(width > 0) || !(height > 0) || !std::isfinite(width) || !std::isfinite(height))
    throw std::invalid_argument("rectangle mesh: width and height must be positive and finite");
  if (nx < 1 || ny < 1 || nx > 10000 || ny > 10000)
    throw std::invalid_argument("rectangle mesh: nx and ny must be between 1 and 10000");
  return make_grid({.x = {.breaks = {0, width}, .elements = {nx}},
                    .y = {.breaks = {0, height}, .elements = {ny}},
                    .left = {"axis"},
                    .right = {"side"}});
}

}  // namespace voussoir::fem
