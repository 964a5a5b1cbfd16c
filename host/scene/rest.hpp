#pragma once
/// Level ground at rest: its layers, and the tractions with which it holds a boundary, eqs. (15), (16).

#include <set>
#include <string>
#include <vector>

#include "host/scene/k0_table.hpp"
#include "host/scene/scene.hpp"

namespace voussoir::host {

/// A level layer and the region that it is of.
struct GroundLayer {
  std::string region = {};     ///< empty where the mesh has no regions
  double bottom = 0, top = 0;  ///< y [m]
  double unit_weight = 0;      ///< [N/m3]
};

/// The layers from the surface down. Throws std::runtime_error, whose text begins with `key`, where the surface or the
/// layers are not level. Edges of `openings`, the boundaries that are pressed at rest, need not be level.
[[nodiscard]] std::vector<GroundLayer> level_layers(const Scene& scene, const std::set<std::string>& openings,
                                                    const std::string& key);

/// The layers of the scene with their K0.
struct GroundAtRest {
  std::vector<GroundLayer> layers = {};
  std::vector<K0Table> k0 = {};  ///< of each layer
  double pressure = 0;           ///< p0 on the surface [Pa]

  /// Nodal forces of the tractions with which the ground at rest at a load factor holds the edges [N/m].
  [[nodiscard]] Eigen::VectorXd force(const fem::Coordinates& coordinates, const std::vector<fem::Edge>& edges,
                                      double load_factor) const;
};

}  // namespace voussoir::host
