#include "host/scene/rest.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace voussoir::host {
namespace {

struct Extent {
  double bottom = std::numeric_limits<double>::infinity();
  double top = -std::numeric_limits<double>::infinity();
  void add(double y) {
    bottom = std::min(bottom, y);
    top = std::max(top, y);
  }
};

std::vector<Extent> extents_of(const fem::Mesh& mesh) {
  std::vector<Extent> extents(std::max<std::size_t>(1, mesh.region_names.size()));
  for (int e = 0; e < mesh.n_elements(); ++e) {
    const std::size_t region = mesh.region.empty() ? 0 : static_cast<std::size_t>(mesh.region[e]);
    for (const int node : mesh.elements[e]) extents[region].add(mesh.coordinates(1, node));
  }
  return extents;
}

/// The edges that look upwards, but for those of openings, are at the height of the surface.
void check_surface(const Scene& scene, const std::set<std::string>& openings, const std::string& key, double surface,
                   double near) {
  const auto check = [&](const std::string& name, const std::vector<fem::Edge>& edges) {
    for (const fem::Edge& edge : edges) {
      const fem::Point a = scene.mesh.coordinates.col(edge[0]), b = scene.mesh.coordinates.col(edge[2]);
      if (b.x() - a.x() > -1e-6 * (b - a).norm()) continue;  // the soil is on the left, so that it looks down or aside
      if (std::abs(a.y() - surface) <= near && std::abs(b.y() - surface) <= near) continue;
      throw std::runtime_error(fmt::format(
          "{}: needs a level surface and level layers: {} spans y = {:.6g} to {:.6g} m", key,
          name.empty() ? "the surface" : name, std::min({a.y(), b.y(), surface}), std::max({a.y(), b.y(), surface})));
    }
  };
  for (const auto& [name, edges] : scene.mesh.edges) {
    if (!openings.contains(name)) check(name, edges);
  }
  check("", scene.mesh.unnamed_edges);
}

}  // namespace

std::vector<GroundLayer> level_layers(const Scene& scene, const std::set<std::string>& openings,
                                      const std::string& key) {
  const fem::Mesh& mesh = scene.mesh;
  const std::vector<Extent> extents = extents_of(mesh);
  Extent whole;
  for (const Extent& extent : extents) {
    whole.add(extent.bottom);
    whole.add(extent.top);
  }
  const double near = 1e-9 * (whole.top - whole.bottom);
  check_surface(scene, openings, key, whole.top, near);
  std::vector<GroundLayer> layers;
  for (std::size_t k = 0; k < extents.size(); ++k) {
    const std::string name = mesh.region_names.empty() ? "" : mesh.region_names[k];
    const auto first = mesh.region.empty() ? 0
                                           : std::find(mesh.region.begin(), mesh.region.end(), static_cast<int>(k)) -
                                                 mesh.region.begin();
    layers.push_back({name, extents[k].bottom, extents[k].top, scene.unit_weight(static_cast<int>(first))});
  }
  std::sort(layers.begin(), layers.end(), [](const GroundLayer& a, const GroundLayer& b) { return a.top > b.top; });
  for (std::size_t k = 1; k < layers.size(); ++k) {
    if (std::abs(layers[k].top - layers[k - 1].bottom) <= near) continue;
    throw std::runtime_error(fmt::format(
        "{}: needs a level surface and level layers: region {} ends at y = {:.6g} m, region {} begins at {:.6g} m", key,
        layers[k - 1].region, layers[k - 1].bottom, layers[k].region, layers[k].top));
  }
  return layers;
}

Eigen::VectorXd GroundAtRest::force(const fem::Coordinates& coordinates, const std::vector<fem::Edge>& edges,
                                    double load_factor) const {
  fem::GeostaticStress stress{.layers = {},
                              .height = layers.front().top,
                              .surcharge = pressure,
                              .load_factor = load_factor,
                              .k0 = [this](std::size_t layer, double s_yy) { return k0[layer].at(-s_yy); }};
  for (const GroundLayer& layer : layers) stress.layers.push_back({layer.bottom, layer.unit_weight});
  return fem::traction_force(coordinates, edges, stress);
}

}  // namespace voussoir::host
