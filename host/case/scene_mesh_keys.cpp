#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "host/case/keys.hpp"
#include "host/case/scene_keys.hpp"
#include "io/units.hpp"

namespace voussoir::host {

using io::Dimension;

namespace {

constexpr std::size_t most_intervals = 1000;
constexpr std::int64_t most_elements = 1'000'000;  ///< of a shape

constexpr std::array<std::pair<MeshShape, const char*>, 4> shape_names{{{MeshShape::grid, "grid"},
                                                                        {MeshShape::half_tunnel, "half_tunnel"},
                                                                        {MeshShape::tunnel, "tunnel"},
                                                                        {MeshShape::ring, "ring"}}};

const char* name_of(MeshShape shape) {
  for (const auto& [candidate, name] : shape_names) {
    if (candidate == shape) return name;
  }
  return "file";
}

/// Lengths of neighbouring elements within one interval differ by this ratio.
const io::QuantityRule ratio_rule{.at_least = "0.1", .at_most = "10"};

/// Refuses a ratio that would make elements of no length beside others.
void check_ratio(const io::Table& table, const io::Key& key, double ratio, std::int64_t count) {
  constexpr double most = 1e6;
  if (std::abs(static_cast<double>(count - 1) * std::log(ratio)) > std::log(most))
    throw table.error(key.name, fmt::format("makes {} elements whose lengths differ by more than a million", count));
}

/// One entry for each interval; a single one stands for all.
template <class T>
void spread(const io::Table& table, const io::Key& key, const char* along, std::size_t intervals,
            std::vector<T>& entries) {
  if (entries.size() == 1) entries.resize(intervals, entries.front());
  if (entries.size() != intervals)
    throw table.error(key.name, fmt::format("must have one entry for each of the {} intervals of {}, has {}", intervals,
                                            along, entries.size()));
}

struct AxisKeys {
  const char* along;
  io::Key points, counts, ratios;
};

constexpr AxisKeys x_keys{
    "x",
    {"x", "Breakpoints of a grid along x, ascending; the intervals between them have columns of elements."},
    {"columns",
     "Number of columns of elements: in a grid one for each interval of `x`, in a ring the one number of elements "
     "around."},
    {"x_ratio",
     "Length of a column over that of the one to its left, for each interval of `x` or one for all; 1 makes columns of "
     "equal length."}};
constexpr AxisKeys y_keys{
    "y",
    {"y", "Breakpoints of a grid along y, ascending; the intervals between them have rows of elements."},
    {"rows",
     "Number of rows of elements: in a grid one for each interval of `y`, upwards, in a ring the one number of "
     "elements outwards."},
    {"y_ratio",
     "Height of a row over that of the one below it, for each interval of `y` or one for all; 1 makes rows of equal "
     "height."}};

const io::IntegerRule count_rule{.at_least = 1, .at_most = 10'000};

std::vector<std::int64_t> read_counts(const io::Table& table, const io::Key& key) {
  return table.integers(key, count_rule, {}, {.least = 1, .most = most_intervals, .or_one = true});
}

void read_axis(const io::Table& table, const AxisKeys& keys, std::vector<double>& points,
               std::vector<std::int64_t>& counts, std::vector<double>& ratios) {
  points = table.quantities(keys.points, Dimension::length, coordinate_rule, {},
                            {.least = 2, .most = most_intervals + 1});
  for (std::size_t k = 1; k < points.size(); ++k) {
    if (!(points[k] > points[k - 1])) throw table.error(keys.points.name, "must ascend");
  }
  const std::size_t intervals = points.size() - 1;
  counts = read_counts(table, keys.counts);
  if (counts.size() != intervals) {
    throw table.error(keys.counts.name, fmt::format("must have one entry for each of the {} intervals of {}, has {}",
                                                    intervals, keys.along, counts.size()));
  }
  ratios = table.quantities(keys.ratios, Dimension::none, ratio_rule, std::vector<std::string>{"1"},
                            {.least = 1, .most = most_intervals, .or_one = true});
  spread(table, keys.ratios, keys.along, intervals, ratios);
  for (std::size_t k = 0; k < intervals; ++k) check_ratio(table, keys.ratios, ratios[k], counts[k]);
}

std::vector<std::string> read_names(const io::Table& table, const io::Key& key, const std::string& otherwise) {
  return table.texts(key, std::vector{otherwise}, column_name_rule,
                     {.least = 1, .most = most_intervals, .or_one = true});
}

constexpr io::Key layers_key{
    "layers",
    "Names of the regions, from the base upwards: in a grid one for each interval of `y`, or one for all; in a tunnel "
    "one more than `interfaces` has entries."};

/// Reads `layers` or `regions` of a grid.
void read_grid_regions(const io::Table& table, SceneMeshCase& mesh) {
  const std::size_t columns = mesh.x.size() - 1, rows = mesh.y.size() - 1;
  constexpr io::Key regions_key{"regions",
                                "Names of the regions of a grid whose regions change along x, too, in place of "
                                "`layers`: a list for each interval "
                                "of `y`, upwards, with a name for each interval of `x`."};
  mesh.regions = table.lists_of_texts(regions_key);
  if (mesh.regions.empty()) {
    mesh.layers = read_names(table, layers_key, "ground");
    spread(table, layers_key, "y", rows, mesh.layers);
    return;
  }
  if (table.has("layers")) throw table.error("layers", "is given beside regions: one of the two names the regions");
  if (mesh.regions.size() != rows)
    throw table.error("regions", fmt::format("must have a list for each of the {} intervals of y, has {}", rows,
                                             mesh.regions.size()));
  for (const std::vector<std::string>& row : mesh.regions) {
    if (row.size() != columns)
      throw table.error("regions", fmt::format("must have a name for each of the {} intervals of x in each list, has "
                                               "{} in one",
                                               columns, row.size()));
  }
}

void read_grid(const io::Table& table, SceneMeshCase& mesh) {
  read_axis(table, x_keys, mesh.x, mesh.columns, mesh.x_ratio);
  read_axis(table, y_keys, mesh.y, mesh.rows, mesh.y_ratio);
  const auto total = [](const std::vector<std::int64_t>& counts) {
    return std::accumulate(counts.begin(), counts.end(), std::int64_t{0});
  };
  const std::int64_t elements = total(mesh.columns) * total(mesh.rows);
  if (elements > most_elements)
    throw table.error("columns", fmt::format("makes {} elements with the rows, more than {}", elements, most_elements));
  const std::size_t columns = mesh.x.size() - 1, rows = mesh.y.size() - 1;
  const auto side = [&](const io::Key& key, const char* along, std::size_t intervals, std::vector<std::string>& names) {
    names = read_names(table, key, std::string(key.name));
    spread(table, key, along, intervals, names);
  };
  side({"base", "Names of the boundary along the base of a grid, for each interval of `x` or one for all."}, "x",
       columns, mesh.base);
  side({"top", "Names of the boundary along the top of a grid, for each interval of `x` or one for all."}, "x", columns,
       mesh.top);
  side({"left", "Names of the boundary on the left of a grid, for each interval of `y`, upwards, or one for all."}, "y",
       rows, mesh.left);
  side({"right", "Names of the boundary on the right of a grid, for each interval of `y`, upwards, or one for all."},
       "y", rows, mesh.right);
  read_grid_regions(table, mesh);
}

const io::QuantityRule size_rule{.at_least = "1 mm", .at_most = "10 km"};

/// Reads the layers of a tunnel's ground.
void read_tunnel_layers(const io::Table& table, SceneMeshCase& mesh) {
  mesh.interfaces = table.quantities(
      {"interfaces", "Heights above the base of the lines between the layers of a tunnel's ground, ascending."},
      Dimension::length, size_rule, std::vector<std::string>{}, {.most = 100});
  for (std::size_t k = 0; k < mesh.interfaces.size(); ++k) {
    if (k > 0 && !(mesh.interfaces[k] > mesh.interfaces[k - 1])) throw table.error("interfaces", "must ascend");
    if (mesh.interfaces[k] >= mesh.height) throw table.error("interfaces", "must lie below the height");
  }
  mesh.layers = read_names(table, layers_key, "ground");
  if (mesh.layers.size() != mesh.interfaces.size() + 1)
    throw table.error("layers", fmt::format("must have {} entries, one more than interfaces, has {}",
                                            mesh.interfaces.size() + 1, mesh.layers.size()));
}

void read_tunnel(const io::Table& table, SceneMeshCase& mesh) {
  mesh.width = table.quantity(
      {"width", "Width of a tunnel's ground: of the half on one side of the axis, or of the whole in shape `tunnel`."},
      Dimension::length, {.at_least = "1.5 cm", .at_most = "20 km"});
  mesh.height = table.quantity({"height", "Height of a tunnel's ground from its base to the surface."},
                               Dimension::length, {.at_least = "1 cm", .at_most = "10 km"});
  mesh.diameter = table.quantity({"diameter", "Diameter D of a tunnel."}, Dimension::length,
                                 {.at_least = "1 cm", .at_most = "1 km"});
  mesh.cover_ratio = table.quantity({"cover_ratio",
                                     "Cover-to-diameter ratio C/D: the ground above the crown over the tunnel's "
                                     "diameter. At least D/2 of ground must "
                                     "remain below the invert."},
                                    Dimension::none, {.at_least = "0.25", .at_most = "20"});
  mesh.size_opening = table.quantity(
      {"size_opening", "Size of the elements at the opening of a tunnel, at most half the diameter."},
      Dimension::length, {.at_least = "1 mm", .at_most = "500 m"});
  mesh.size_far = table.quantity({"size_far", "Size of the elements of a tunnel's ground far from the opening."},
                                 Dimension::length, size_rule);
  const double invert = mesh.height - (mesh.cover_ratio + 1) * mesh.diameter;
  const double least_width = (mesh.shape == MeshShape::tunnel ? 3.0 : 1.5) * mesh.diameter;
  if (invert < 0.5 * mesh.diameter) throw table.error("cover_ratio", "leaves less than D/2 of ground below the invert");
  if (mesh.width < least_width)
    throw table.error("width", fmt::format("is less than {:g} tunnel diameters", least_width / mesh.diameter));
  if (mesh.size_opening > 0.5 * mesh.diameter) throw table.error("size_opening", "is more than half the diameter");
  if (mesh.size_far < mesh.size_opening) throw table.error("size_far", "is smaller than size_opening");
  read_tunnel_layers(table, mesh);
}

int read_count(const io::Table& table, const io::Key& key) {
  const std::vector<std::int64_t> counts = read_counts(table, key);
  if (counts.size() != 1) throw table.error(key.name, "must be one number for a ring");
  return static_cast<int>(counts.front());
}

void read_ring(const io::Table& table, SceneMeshCase& mesh) {
  mesh.radius = table.quantity({"radius", "Inner radius of a ring, whose centre is (0, 0)."}, Dimension::length,
                               {.at_least = "1 mm", .at_most = "1 km"});
  mesh.outer = table.quantity({"outer", "Outer radius of a ring."}, Dimension::length, size_rule);
  mesh.ring_columns = read_count(table, x_keys.counts);
  mesh.ring_rows = read_count(table, y_keys.counts);
  constexpr io::Key ratio_key{"ratio",
                              "Length of an element of a ring, outwards, over that of the one inside it; 1 makes "
                              "elements of equal length."};
  mesh.ratio = table.quantity(ratio_key, Dimension::none,
                              {.fallback = "1", .at_least = ratio_rule.at_least, .at_most = ratio_rule.at_most});
  const std::string part = table.choice({"part", "Which part of a ring the mesh has, from x = 0 and y = 0 on."},
                                        {"quarter", "half", "whole"}, "quarter");
  mesh.part = part == "quarter" ? RingPart::quarter : part == "half" ? RingPart::half : RingPart::whole;
  if (mesh.outer < 1.01 * mesh.radius) throw table.error("outer", "is less than 1.01 times radius");
  check_ratio(table, ratio_key, mesh.ratio, mesh.ring_rows);
  if (std::int64_t{mesh.ring_columns} * mesh.ring_rows > most_elements)
    throw table.error("columns", fmt::format("makes more than {} elements with the rows", most_elements));
}

/// Says to which shape a key belongs that this mesh does not read.
void refuse_keys_of_other_shapes(const io::Table& table, MeshShape shape) {
  using enum MeshShape;
  struct Row {
    std::vector<const char*> keys;
    std::vector<MeshShape> shapes;
  };
  static const std::vector<Row> rows{
      {{"x", "y", "x_ratio", "y_ratio", "base", "top", "left", "right", "regions"}, {grid}},
      {{"columns", "rows"}, {grid, ring}},
      {{"layers"}, {grid, half_tunnel, tunnel}},
      {{"width", "height", "diameter", "cover_ratio", "size_opening", "size_far", "interfaces"}, {half_tunnel, tunnel}},
      {{"radius", "outer", "ratio", "part"}, {ring}}};
  for (const Row& row : rows) {
    if (std::find(row.shapes.begin(), row.shapes.end(), shape) != row.shapes.end()) continue;
    std::vector<const char*> names;
    for (const MeshShape has : row.shapes) names.push_back(name_of(has));
    for (const char* key : row.keys) {
      if (table.has(key))
        throw table.error(key, fmt::format("is a key of the shape {}, and this mesh is a {}", fmt::join(names, ", "),
                                           name_of(shape)));
    }
  }
}

}  // namespace

SceneMeshCase read_scene_mesh(const io::Table& table) {
  SceneMeshCase mesh;
  const auto file = table.optional_path(
      {"file",
       "Mesh file of Gmsh (`.msh`, version 2.2 or 4.1) with quadrilaterals of 4 or 8 nodes. Its physical curves are "
       "the boundaries, its physical surfaces the regions, its physical points the points."});
  const auto unit = table.optional_quantity({"unit", "Length of 1 in the mesh file; without the key it is 1 m."},
                                            Dimension::length, {.at_least = "0.001 mm", .at_most = "1 km"});
  if (file && table.has("shape")) throw table.error("shape", "is given beside file: a mesh has one of the two");
  if (!file && !table.has("shape")) throw table.error("shape", "is missing: a mesh needs a shape or a file");
  if (!file && unit) throw table.error("unit", "is given without file, whose lengths it says");
  mesh.layers.clear();
  if (file) {
    mesh.shape = MeshShape::file;
    mesh.file = *file;
    mesh.unit = unit.value_or(1.0);
  } else {
    std::vector<std::string> names;
    for (const auto& [shape, name] : shape_names) names.emplace_back(name);
    const std::string wanted = table.choice(
        {"shape",
         "Shape of a mesh without a file: a rectangle of elements (`grid`), the ground of a tunnel on one side of its "
         "axis (`half_tunnel`) or on both (`tunnel`), or a circular hole and the ground around it (`ring`)."},
        names, std::string(shape_names.front().second), "none");
    for (const auto& [shape, name] : shape_names) {
      if (wanted == name) mesh.shape = shape;
    }
  }
  refuse_keys_of_other_shapes(table, mesh.shape);
  if (mesh.shape == MeshShape::grid) read_grid(table, mesh);
  if (mesh.shape == MeshShape::half_tunnel || mesh.shape == MeshShape::tunnel) read_tunnel(table, mesh);
  if (mesh.shape == MeshShape::ring) {
    read_ring(table, mesh);
    mesh.layers = {"ground"};
  }
  return mesh;
}

}  // namespace voussoir::host
