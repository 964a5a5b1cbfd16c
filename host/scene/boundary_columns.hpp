#pragma once
/// What the boundaries of a scene bear and how far they have moved, as columns of the table of increments.

#include <map>
#include <set>
#include <string>
#include <vector>

#include "fem/increment.hpp"
#include "host/scene/scene.hpp"
#include "host/stages/ground.hpp"
#include "io/result_data.hpp"

namespace voussoir::host {

using NodesByName = std::map<std::string, std::set<int>>;

/// The boundaries that something holds or moves in any stage, and those whose area changes: the same columns in all
/// stages.
struct WatchedBoundaries {
  std::vector<std::string> held;
  std::map<std::string, fem::Point> with_area;  ///< with the centre of the motion [m]
};
[[nodiscard]] WatchedBoundaries watched(const std::vector<StagePlan>& plans);

/// Adds, of each boundary NAME and axis x, y:
///   reaction_NAME_x     sum of the reactions that the boundary owns, of the support on the ground [N/m]
///   displacement_NAME_x mean displacement of its nodes [m]
///   traction_NAME_x     the reaction over the width of the nodes that it owns [Pa]; not for curves inside the ground
///   area_NAME           area that the opening has lost over its first area [-]
/// and tensile_nodes, the number of the nodes at which what holds them pulls the ground outwards, each node once.
/// `reactions` as fem::Increment::reactions [N/m], `coordinates` those on which they were integrated [m], `pulled` the
/// tensile_nodes of both.
void add_boundary_columns(const WatchedBoundaries& boundaries, const StagePlan& plan, const Ground& ground,
                          const Eigen::VectorXd& reactions, const fem::Coordinates& coordinates,
                          const NodesByName& pulled, io::Quantities& to);

/// The names of these columns.
[[nodiscard]] std::vector<std::string> column_names(const WatchedBoundaries& boundaries, const fem::Mesh& mesh);

/// The area that an opening has lost, over its first area [-]: within a closed chain, or between a chain and the lines
/// from its ends to the point `about` [m].
[[nodiscard]] double lost_area(const Ground& ground, const std::string& boundary,
                               const fem::Point& about = fem::Point::Zero());

/// Nodes at which a held boundary, curve or point pulls the ground outwards, by the names of these; a node that two of
/// them own along different axes may be with both. Where the ground is on both sides, it has no outward normal, and no
/// node is there; that changes when one side is dug out.
[[nodiscard]] NodesByName tensile_nodes(const fem::Mesh& mesh, const StagePlan& plan, const Eigen::VectorXd& reactions,
                                        const fem::Coordinates& coordinates);

}  // namespace voussoir::host
