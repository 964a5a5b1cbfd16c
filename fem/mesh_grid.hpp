#pragma once
/// Structured meshes: a grid of lines parallel to the axes, and a ring.

#include <cstdint>
#include <string>
#include <vector>

#include "fem/mesh.hpp"

namespace voussoir::fem {

constexpr double max_elements = 2e6;  ///< more elements than this show that a number or a size is mistyped

/// Breakpoints along one axis, and the elements of each interval between them.
struct GridAxis {
  std::vector<double> breaks;          ///< ascending, at least two [m]
  std::vector<std::int64_t> elements;  ///< of each interval
  std::vector<double> ratio = {};  ///< of an element's length to that of the one before it, of each interval; empty: 1
};

/// Names have one entry an interval, or one for all of them.
struct GridOptions {
  GridAxis x, y;
  std::vector<std::string> base = {"base"}, top = {"top"};      ///< of the boundaries, by interval of x
  std::vector<std::string> left = {"left"}, right = {"right"};  ///< by interval of y
  std::vector<std::string> layers = {};                         ///< of the regions, by interval of y; empty: no regions
  /// Names of regions where they change along x, too: a row for each interval of y, upwards, with a name for each
  /// interval of x. Empty: `layers` counts.
  std::vector<std::vector<std::string>> regions = {};
};

/// The corners of `elements` elements from a to b, both included, of which each is `ratio` times as long as the one
/// before it [m].
[[nodiscard]] std::vector<double> graded_line(double a, double b, std::int64_t elements, double ratio);

/// A grid with the points "base_left", "base_right", "top_left" and "top_right"; corners are numbered along x first,
/// from the base upwards. Throws std::invalid_argument, whose sentence begins with the name of the key that is at fault
/// ("rows: ...": those of [mesh], docs/reference/keys.md).
[[nodiscard]] Mesh make_grid(const GridOptions& options);

/// Regions of a mesh in layers: `layer` of each element is an index into `names`, in which names may repeat.
void set_layers(Mesh& mesh, const std::vector<std::string>& names, const std::vector<int>& layer);

struct RingOptions {
  double radius = 1;          ///< of the cavity [m]
  double outer = 10;          ///< radius of the far boundary [m]
  std::int64_t columns = 16;  ///< elements around
  std::int64_t rows = 16;     ///< elements outwards
  double ratio = 1;           ///< of an element's length to that of the one inside it [-]
  int quarters = 1;           ///< 1: x and y positive; 2: x positive; 4: the whole ring
};

/// A ring about (0, 0), whose corners and midsides lie on circles. Its boundaries are "cavity" and "far", and where it
/// is not whole "x0" (x = 0), for a quarter also "y0" (y = 0). Throws std::invalid_argument as make_grid.
[[nodiscard]] Mesh make_ring(const RingOptions& options);

}  // namespace voussoir::fem
