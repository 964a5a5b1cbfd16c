#include "host/scene/scene.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

namespace voussoir::host {
namespace {

std::string name_of_node(const fem::Mesh& mesh, int node) {
  return fmt::format("the point ({:.4g}, {:.4g}) m", mesh.coordinates(0, node), mesh.coordinates(1, node));
}

}  // namespace

double Scene::unit_weight(int element) const {
  const auto found = std::find_if(input.regions.begin(), input.regions.end(),
                                  [&](const RegionCase& region) { return mesh.in_region(element, region.names); });
  return found == input.regions.end() ? 0.0 : found->unit_weight;
}

Target Holder::target() const {
  if (is_boundary) return {.boundary = name};
  return {.boundary = "", .node = nodes.empty() ? -1 : nodes.front()};
}

fem::Point Holder::displacement(const fem::Point& x, double from, double to, const fem::Point& centre) const {
  if (move.is_affine()) {
    const auto at = [&](double parameter) {
      return fem::affine_displacement(x, centre, move.rotation.value_or(0) * parameter,
                                      move.area.value_or(0) * parameter);
    };
    return at(to) - at(from);
  }
  return (to - from) * fem::Point(move.x.value_or(0), move.y.value_or(0));
}

const BoundaryLoad* StagePlan::load_of(const std::string& boundary) const {
  const auto found = std::find_if(loads.begin(), loads.end(),
                                  [&](const BoundaryLoad& load) { return load.boundary == boundary; });
  return found == loads.end() ? nullptr : &*found;
}

std::string name_of(const fem::Mesh& mesh, const Holder& holder) {
  return holder.name.empty() ? name_of_node(mesh, holder.nodes.front()) : holder.name;
}

std::string name_of(const fem::Mesh& mesh, const ReleaseCase& release) {
  if (!release.boundary.empty()) return release.boundary;
  return release.point.name.empty() ? name_of_node(mesh, node_at(mesh, release.point)) : release.point.name;
}

Target target_of(const fem::Mesh& mesh, const ReleaseCase& release) {
  if (!release.boundary.empty()) return {.boundary = release.boundary};
  return {.boundary = "", .node = node_at(mesh, release.point)};
}

int node_at(const fem::Mesh& mesh, const PlaceCase& place) {
  if (!place.name.empty()) return mesh.point(place.name);
  const fem::Point wanted(place.at[0], place.at[1]);
  Eigen::Index nearest = 0;
  const double distance = (mesh.coordinates.colwise() - wanted).colwise().norm().minCoeff(&nearest);
  const double size = (mesh.coordinates.rowwise().maxCoeff() - mesh.coordinates.rowwise().minCoeff()).norm();
  return distance <= 1e-6 * size ? static_cast<int>(nearest) : -1;
}

const std::vector<fem::Edge>& outer_edges(const fem::Mesh& mesh, const std::string& boundary) {
  static const std::vector<fem::Edge> none;
  const auto found = mesh.edges.find(boundary);
  return found == mesh.edges.end() ? none : found->second;
}

fem::Point coordinates_of(const fem::Mesh& mesh, const PlaceCase& place) {
  if (!place.name.empty()) return mesh.coordinates.col(mesh.point(place.name));
  return {place.at[0], place.at[1]};
}

}  // namespace voussoir::host
