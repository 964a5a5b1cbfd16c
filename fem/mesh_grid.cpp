#include "fem/mesh_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <stdexcept>

#include "fem/mesh_builder.hpp"

namespace voussoir::fem {

namespace {

void require(bool holds, const std::string& sentence) {
  if (!holds) throw std::invalid_argument(sentence);
}

bool is_length(double value) { return std::isfinite(value) && value > 0; }

void require_ratio(double ratio, const std::string& key) {
  require(is_length(ratio) && ratio >= 0.01 && ratio <= 100, key + ": a ratio of lengths must be between 0.01 and 100");
}

void require_elements(std::int64_t elements, const std::string& key) {
  require(elements >= 1, key + ": at least one element is needed");
  require(static_cast<double>(elements) <= max_elements, key + ": more than two million elements");
}

/// The value of interval k, where one value may stand for all of them.
template <class Value>
const Value& of_interval(const std::vector<Value>& values, std::size_t k) {
  return values.size() == 1 ? values.front() : values[k];
}

struct AxisKeys {
  const char *breaks, *elements, *ratio;
};

void require_count(std::size_t count, std::size_t intervals, const std::string& key, const char* what) {
  require(count == intervals || count == 1,
          key + ": " + std::to_string(count) + " " + what + " for " + std::to_string(intervals) + " intervals");
}

void check(const GridAxis& axis, const AxisKeys& keys) {
  const std::string breaks = keys.breaks;
  require(axis.breaks.size() >= 2, breaks + ": at least two breakpoints are needed");
  for (std::size_t k = 0; k < axis.breaks.size(); ++k) {
    require(std::isfinite(axis.breaks[k]), breaks + ": a breakpoint must be finite");
    require(k == 0 || axis.breaks[k] > axis.breaks[k - 1], breaks + ": the breakpoints must ascend");
  }
  const std::size_t intervals = axis.breaks.size() - 1;
  require(axis.elements.size() == intervals, std::string(keys.elements) + ": " + std::to_string(axis.elements.size()) +
                                                 " numbers for " + std::to_string(intervals) + " intervals of " +
                                                 breaks);
  for (const std::int64_t elements : axis.elements) require_elements(elements, keys.elements);
  if (!axis.ratio.empty()) require_count(axis.ratio.size(), intervals, keys.ratio, "ratios");
  for (const double ratio : axis.ratio) require_ratio(ratio, keys.ratio);
}

/// The lines of a grid across one axis, and the interval in which the elements between them lie.
struct Lines {
  std::vector<double> position;  ///< [m]
  std::vector<int> interval;     ///< of the elements that start at each line but the last
  [[nodiscard]] int elements() const { return static_cast<int>(interval.size()); }
};

Lines lines_of(const GridAxis& axis, const AxisKeys& keys) {
  check(axis, keys);
  Lines lines;
  for (std::size_t k = 0; k + 1 < axis.breaks.size(); ++k) {
    const double ratio = axis.ratio.empty() ? 1 : of_interval(axis.ratio, k);
    const std::vector<double> part = graded_line(axis.breaks[k], axis.breaks[k + 1], axis.elements[k], ratio);
    for (std::size_t i = 0; i + 1 < part.size(); ++i)
      require(part[i + 1] > part[i], std::string(keys.ratio) + ": the smallest element has no length");
    lines.position.insert(lines.position.end(), part.begin() + (k == 0 ? 0 : 1), part.end());
    lines.interval.insert(lines.interval.end(), axis.elements[k], static_cast<int>(k));
  }
  return lines;
}

void check_names(const std::vector<std::string>& names, std::size_t intervals, const std::string& key) {
  require_count(names.size(), intervals, key, "names");
  for (const std::string& name : names) require(!name.empty(), key + ": a name must not be empty");
}

void check_names(const GridOptions& o) {
  const std::size_t nx = o.x.breaks.size() - 1;
  const std::size_t ny = o.y.breaks.size() - 1;
  check_names(o.base, nx, "base");
  check_names(o.top, nx, "top");
  check_names(o.left, ny, "left");
  check_names(o.right, ny, "right");
  if (!o.layers.empty()) check_names(o.layers, ny, "layers");
  if (o.regions.empty()) return;
  require_count(o.regions.size(), ny, "regions", "rows");
  for (const std::vector<std::string>& row : o.regions) check_names(row, nx, "regions");
}

QuadMesh quads_of(const Lines& x, const Lines& y) {
  const int nx = x.elements();
  const int ny = y.elements();
  QuadMesh mesh;
  mesh.corners.resize(2, (nx + 1) * (ny + 1));
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) mesh.corners.col(j * (nx + 1) + i) << x.position[i], y.position[j];
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const int first = j * (nx + 1) + i;
      mesh.quads.push_back({first, first + 1, first + nx + 2, first + nx + 1});
    }
  return mesh;
}

void name_regions(Mesh& mesh, const GridOptions& o, const Lines& x, const Lines& y) {
  if (o.layers.empty() && o.regions.empty()) return;
  std::vector<std::string> names = o.layers;
  std::vector<int> name_of;
  if (!o.regions.empty()) names.clear();
  for (const std::vector<std::string>& row : o.regions) {
    for (std::size_t i = 0; i + 1 < o.x.breaks.size(); ++i) names.push_back(row.size() == 1 ? row.front() : row[i]);
  }
  const int intervals = static_cast<int>(o.x.breaks.size()) - 1;
  const auto rows = static_cast<int>(o.regions.size());
  for (int e = 0; e < mesh.n_elements(); ++e) {
    const int row = y.interval[e / x.elements()];
    if (rows > 0) {
      name_of.push_back((rows == 1 ? 0 : row) * intervals + x.interval[e % x.elements()]);
    } else {
      name_of.push_back(names.size() == 1 ? 0 : row);
    }
  }
  set_layers(mesh, names, name_of);
}

}  // namespace

std::vector<double> graded_line(double a, double b, std::int64_t elements, double ratio) {
  std::vector<double> line;
  const double n = static_cast<double>(elements);
  const double logarithm = std::log(ratio);
  for (std::int64_t k = 0; k < elements; ++k) {
    const double i = static_cast<double>(k);
    // Sums of the geometric series, (ratio^i - 1) / (ratio^n - 1), such that no power overflows.
    if (ratio == 1) line.push_back(a + (b - a) * i / n);
    if (ratio < 1) line.push_back(a + (b - a) * (std::expm1(i * logarithm) / std::expm1(n * logarithm)));
    if (ratio > 1)
      line.push_back(a + (b - a) *
                             (std::exp((i - n) * logarithm) * std::expm1(-i * logarithm) / std::expm1(-n * logarithm)));
  }
  line.push_back(b);
  return line;
}

void set_layers(Mesh& mesh, const std::vector<std::string>& names, const std::vector<int>& layer) {
  mesh.region_names.clear();
  std::vector<int> region_of;
  for (const std::string& name : names) {
    const auto found = std::find(mesh.region_names.begin(), mesh.region_names.end(), name);
    region_of.push_back(static_cast<int>(found - mesh.region_names.begin()));
    if (found == mesh.region_names.end()) mesh.region_names.push_back(name);
  }
  mesh.region.clear();
  for (const int k : layer) mesh.region.push_back(region_of[k]);
}

Mesh make_grid(const GridOptions& o) {
  const Lines x = lines_of(o.x, {"x", "columns", "x_ratio"});
  const Lines y = lines_of(o.y, {"y", "rows", "y_ratio"});
  const int nx = x.elements();
  const int ny = y.elements();
  check_names(o);
  require(static_cast<double>(nx) * ny <= max_elements, "rows: the grid would have more than two million elements");
  Mesh mesh = complete_q8(quads_of(x, y), [&](int a, int b) -> std::string {
    const int i = std::min(a % (nx + 1), b % (nx + 1));
    const int j = std::min(a / (nx + 1), b / (nx + 1));
    if (std::abs(a - b) == 1) return of_interval(j == 0 ? o.base : o.top, x.interval[i]);
    return of_interval(i == 0 ? o.left : o.right, y.interval[j]);
  });
  mesh.points = {
      {"base_left", 0}, {"base_right", nx}, {"top_left", ny * (nx + 1)}, {"top_right", (ny + 1) * (nx + 1) - 1}};
  name_regions(mesh, o, x, y);
  return mesh;
}

}  // namespace voussoir::fem
