#include "io/mesh_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <stdexcept>

#include "io/checksum.hpp"
#include "io/hdf5.hpp"
#include "io/text_file.hpp"

namespace voussoir::io {

namespace {

constexpr const char* format_name = "voussoir mesh";
constexpr std::int64_t format_version = 1;
constexpr std::size_t most_elements = 2'000'000;  ///< as many as the generator makes

/// Twice the signed area of a quadrilateral [m2].
double twice_area(const StoredMesh& mesh, std::size_t element) {
  std::array<double, 4> x{}, y{};
  for (std::size_t k = 0; k < 4; ++k) {
    const auto node = static_cast<std::size_t>(mesh.quads[4 * element + k]);
    x[k] = mesh.corners[2 * node];
    y[k] = mesh.corners[2 * node + 1];
  }
  return (x[2] - x[0]) * (y[3] - y[1]) - (x[3] - x[1]) * (y[2] - y[0]);
}

/// A sentence that says why the numbers make no mesh; empty when they make one.
std::string fault_of(const StoredMesh& mesh) {
  if (mesh.quads.empty()) return "has no elements";
  if (mesh.quads.size() % 4 != 0 || mesh.corners.size() % 2 != 0) return "its arrays differ in length";
  const auto value = std::find_if_not(mesh.corners.begin(), mesh.corners.end(),
                                      [](double x) { return std::isfinite(x); });
  if (value != mesh.corners.end()) return fmt::format("node {} has no place", (value - mesh.corners.begin()) / 2);
  std::vector<bool> used(mesh.nodes(), false);
  for (std::size_t k = 0; k < mesh.quads.size(); ++k) {
    const std::int64_t node = mesh.quads[k];
    if (node < 0 || node >= static_cast<std::int64_t>(mesh.nodes()))
      return fmt::format("element {} has the node {}, but there are {} nodes", k / 4, node, mesh.nodes());
    used[static_cast<std::size_t>(node)] = true;
  }
  const auto idle = std::find(used.begin(), used.end(), false);
  if (idle != used.end()) return fmt::format("node {} belongs to no element", idle - used.begin());
  for (std::size_t e = 0; e < mesh.elements(); ++e)
    if (!(twice_area(mesh, e) > 0)) return fmt::format("element {} has no area, or its nodes are clockwise", e);
  for (const auto& [name, number] : mesh.numbers)
    if (!std::isfinite(number)) return fmt::format("the number {} is not finite", name);
  return "";
}

/// A checksum of all numbers together. Each array has a checksum of its own against damage; this one tells a file that
/// another program has changed.
std::int64_t content_of(const StoredMesh& mesh) {
  Checksum sum;
  const auto add = [&sum](const auto& values) { sum.add(std::as_bytes(std::span(values))); };
  add(mesh.corners);
  add(mesh.quads);
  for (const auto& [name, number] : mesh.numbers) {
    add(name);
    add(std::array{number});
  }
  return static_cast<std::int64_t>(sum.value());
}

/// Throws unless an array has so many columns and a size that a mesh can have.
void require_shape(const Hdf5File& file, const std::string& array, std::size_t columns, const std::string& path) {
  const std::vector<std::size_t> shape = file.shape(array);
  if (shape.size() != 2 || shape[1] != columns)
    throw std::runtime_error(fmt::format("{}: {} must have {} columns", path, array, columns));
  if (shape[0] > 2 * most_elements)
    throw std::runtime_error(
        fmt::format("{}: {} has {} rows, more than any mesh of this program", path, array, shape[0]));
}

}  // namespace

void save_mesh(const std::filesystem::path& path, const StoredMesh& mesh) {
  const std::string fault = fault_of(mesh);
  if (!fault.empty()) throw std::invalid_argument(fmt::format("mesh for {}: {}", in_one_line(path.string()), fault));
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path());
  Hdf5File file = Hdf5File::create(path);
  file.set_attribute("/", "format", std::string(format_name));
  file.set_attribute("/", "format_version", format_version);
  file.set_attribute("/", "content", content_of(mesh));
  file.write("/corners", mesh.corners, {mesh.nodes(), 2}, "m");
  file.write("/quads", mesh.quads, {mesh.elements(), 4}, "-");
  file.make_group("/numbers");
  for (const auto& [name, value] : mesh.numbers) file.set_attribute("/numbers", name, value);
  file.make_group("/labels");
  for (const auto& [name, value] : mesh.labels) file.set_attribute("/labels", name, value);
  file.publish();
}

StoredMesh load_mesh(const std::filesystem::path& path) {
  const std::string name = in_one_line(path.string());
  const Hdf5File file = Hdf5File::open(path);
  file.require_format(format_name, format_version, "a mesh");
  require_shape(file, "/corners", 2, name);
  require_shape(file, "/quads", 4, name);
  StoredMesh mesh;
  mesh.corners = file.read_doubles("/corners").values;
  mesh.quads = file.read_integers("/quads").values;
  for (const auto& key : file.attributes("/numbers")) mesh.numbers[key] = file.number_attribute("/numbers", key);
  for (const auto& key : file.attributes("/labels")) mesh.labels[key] = file.text_attribute("/labels", key);
  const std::string fault = fault_of(mesh);
  if (!fault.empty()) throw std::runtime_error(fmt::format("{}: {}", name, fault));
  if (file.integer_attribute("/", "content") != content_of(mesh))
    throw std::runtime_error(fmt::format("{}: its mesh was changed after this program had written it", name));
  return mesh;
}

}  // namespace voussoir::io
