#include "host/scene/scene_mesh.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "fem/mesh_file.hpp"
#include "fem/mesh_grid.hpp"
#include "fem/mesh_tunnel.hpp"

namespace voussoir::host {
namespace {

void require(bool holds, const std::string& sentence) {
  if (!holds) throw std::runtime_error("mesh." + sentence);
}

bool is_length(double value) { return std::isfinite(value) && value > 0; }

/// The names of a case, or the default where the case has none.
std::vector<std::string> names_or(const std::vector<std::string>& names, const char* usual) {
  return names.empty() ? std::vector<std::string>{usual} : names;
}

/// What `make` returns; the sentence of an invalid argument of fem begins with a key of [mesh].
template <class Make>
auto with_key(Make&& make) {
  try {
    return make();
  } catch (const std::invalid_argument& fault) {
    throw std::runtime_error(std::string("mesh.") + fault.what());
  }
}

fem::Mesh grid(const SceneMeshCase& m) {
  return with_key([&] {
    return fem::make_grid({.x = {m.x, m.columns, m.x_ratio},
                           .y = {m.y, m.rows, m.y_ratio},
                           .base = names_or(m.base, "base"),
                           .top = names_or(m.top, "top"),
                           .left = names_or(m.left, "left"),
                           .right = names_or(m.right, "right"),
                           .layers = names_or(m.layers, "ground"),
                           .regions = m.regions});
  });
}

fem::Mesh ring(const SceneMeshCase& m) {
  fem::Mesh mesh = with_key([&] {
    return fem::make_ring({.radius = m.radius,
                           .outer = m.outer,
                           .columns = m.ring_columns,
                           .rows = m.ring_rows,
                           .ratio = m.ratio,
                           .quarters = m.part == RingPart::quarter ? 1
                                       : m.part == RingPart::half  ? 2
                                                                   : 4});
  });
  fem::set_layers(mesh, {"ground"}, std::vector<int>(mesh.n_elements(), 0));
  return mesh;
}

/// Half of the ground of both shapes with a tunnel.
fem::HalfTunnelOptions tunnel_options(const SceneMeshCase& m) {
  require(is_length(m.width), "width: it must be positive and finite");
  require(is_length(m.height), "height: it must be positive and finite");
  require(is_length(m.diameter), "diameter: it must be positive and finite");
  require(is_length(m.cover_ratio), "cover_ratio: it must be positive and finite");
  require(is_length(m.size_opening), "size_opening: it must be positive and finite");
  require(is_length(m.size_far), "size_far: it must be positive and finite");
  const fem::HalfTunnelOptions o{.width = m.shape == MeshShape::tunnel ? m.width / 2 : m.width,
                                 .height = m.height,
                                 .diameter = m.diameter,
                                 .cover = m.cover_ratio * m.diameter,
                                 .size_near = m.size_opening,
                                 .size_far = m.size_far,
                                 .interfaces = m.interfaces};
  require(fem::opening_of(o).centre.y() > 0.5 * o.diameter,
          "cover_ratio: the invert lies below the base; less cover or a larger height is needed");
  require(o.width > o.diameter / 2, "width: the tunnel is wider than the ground");
  require(o.size_near <= o.diameter / 2, "size_opening: it is more than half the diameter");
  require(o.size_near <= o.size_far, "size_far: it is smaller than size_opening");
  require(m.layers.size() <= 1 || m.layers.size() == m.interfaces.size() + 1,
          "layers: " + std::to_string(m.layers.size()) + " names for " + std::to_string(m.interfaces.size() + 1) +
              " layers");
  return o;
}

/// What fem says of a tunnel's mesh, without the words in front.
std::string sentence_of(const std::exception& fault) {
  const std::string text = fault.what();
  const std::string subject = "tunnel mesh: ";
  return text.rfind(subject, 0) == 0 ? text.substr(subject.size()) : text;
}

/// @throws std::runtime_error of the key of [mesh] that makes no mesh
fem::Mesh generated_tunnel(const SceneMeshCase& m) {
  const fem::HalfTunnelOptions options = tunnel_options(m);
  try {
    return m.shape == MeshShape::tunnel ? fem::make_tunnel(options) : fem::make_half_tunnel(options);
  } catch (const std::invalid_argument& fault) {
    // All other options have been checked: what remains are interfaces and the number of elements.
    const std::string sentence = sentence_of(fault);
    const bool is_interface = sentence.find("interface") != std::string::npos;
    throw std::runtime_error((is_interface ? "mesh.interfaces: " : "mesh.size_opening: ") + sentence);
  } catch (const std::runtime_error& fault) {
    throw std::runtime_error("mesh.shape: " + sentence_of(fault));
  }
}

/// The boundary of a half tunnel that is called "side" elsewhere is called "right" in scenes.
void name_right(fem::Mesh& mesh) {
  const auto rename = [](auto& sets) {
    auto node = sets.extract("side");
    if (node.empty()) return;
    node.key() = "right";
    sets.insert(std::move(node));
  };
  rename(mesh.edges);
  rename(mesh.nodes);
}

fem::Mesh tunnel(const SceneMeshCase& m) {
  fem::Mesh mesh = generated_tunnel(m);
  name_right(mesh);
  const std::vector<std::string> layers = names_or(m.layers, "ground");
  for (const std::string& name : layers) require(!name.empty(), "layers: a name must not be empty");
  fem::set_layers(mesh, layers,
                  layers.size() == 1 ? std::vector<int>(mesh.n_elements(), 0) : fem::layers_of(mesh, m.interfaces));
  return mesh;
}

SceneMesh file(const SceneMeshCase& m) {
  require(is_length(m.unit), "unit: it must be positive and finite");
  try {
    fem::MeshFile read = fem::read_mesh_file(m.file, m.unit);
    return {std::move(read.mesh), std::move(read.remarks)};
  } catch (const std::runtime_error& fault) {
    throw std::runtime_error(std::string("mesh.file: ") + fault.what());
  }
}

}  // namespace

SceneMesh scene_mesh_with_remarks(const SceneMeshCase& mesh) {
  switch (mesh.shape) {
    case MeshShape::file:
      return file(mesh);
    case MeshShape::grid:
      return {grid(mesh), {}};
    case MeshShape::ring:
      return {ring(mesh), {}};
    case MeshShape::half_tunnel:
    case MeshShape::tunnel:
      return {tunnel(mesh), {}};
  }
  throw std::logic_error("a mesh of a shape that does not exist");
}

fem::Mesh scene_mesh(const SceneMeshCase& mesh) { return scene_mesh_with_remarks(mesh).mesh; }

}  // namespace voussoir::host
