#include "fem/mesh.hpp"

#include <stdexcept>

#include "fem/q8.hpp"

namespace voussoir::fem {

namespace {

template <class Set>
const Set& find_set(const std::map<std::string, Set>& sets, const char* what, const std::string& name) {
  const auto found = sets.find(name);
  if (found != sets.end()) return found->second;
  std::string known;
  for (const auto& [key, value] : sets) known += (known.empty() ? "" : ", ") + key;
  throw std::out_of_range(std::string("the mesh has no ") + what + " '" + name + "'; it has " +
                          (known.empty() ? "none" : known));
}

}  // namespace

const std::vector<Edge>& Mesh::edge_set(const std::string& name) const { return find_set(edges, "boundary", name); }
const std::vector<int>& Mesh::node_set(const std::string& name) const { return find_set(nodes, "boundary", name); }
int Mesh::point(const std::string& name) const { return find_set(points, "point", name); }

double area_left_of(const Coordinates& coordinates, const std::vector<Edge>& chain) {
  double twice = 0;
  for (const Edge& edge : chain)
    for (std::size_t q = 0; q < q8::edge_points.size(); ++q) {
      const Eigen::Vector3d n = q8::edge_shape(q8::edge_points[q]);
      const Eigen::Vector3d d = q8::edge_shape_derivative(q8::edge_points[q]);
      Point x = Point::Zero();
      Point t = Point::Zero();
      for (int k = 0; k < 3; ++k) {
        x += n[k] * coordinates.col(edge[k]);
        t += d[k] * coordinates.col(edge[k]);
      }
      twice += q8::edge_weights[q] * (x.x() * t.y() - x.y() * t.x());
    }
  return 0.5 * twice;
}

}  // namespace voussoir::fem
