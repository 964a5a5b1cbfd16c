#pragma once
/// A scene as it is computed: its nouns, its mesh, and what follows from the two before the first increment.

#include <array>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "fem/boundary.hpp"
#include "fem/mesh.hpp"
#include "host/case/case.hpp"

namespace voussoir::host {

inline constexpr std::array<const char*, 2> axis_names{"x", "y"};

struct Scene {
  SceneCase input = {};
  fem::Mesh mesh = {};    ///< `dug_out` changes from stage to stage
  double pressure = 1e3;  ///< p0: at the start, the stress everywhere and the pressure on all that nothing holds [Pa]
  GravityCase gravity = {};
  /// Pressures act on the first coordinates and stay as they are where the ground moves, as the surcharge of a tunnel.
  bool dead_pressure = false;

  [[nodiscard]] double unit_weight(int element) const;  ///< [N/m3]
};

/// What a stage holds or releases: a boundary by its name, or a point by its node.
struct Target {
  std::string boundary = {};  ///< empty: `node` counts
  int node = -1;
  auto operator<=>(const Target&) const = default;
};

/// What holds nodes on one or both axes: a support, or a boundary or a point that a stage moves.
struct Holder {
  std::string name = {};  ///< of the boundary or the point, in columns and messages
  bool is_boundary = true;
  std::vector<int> nodes = {};
  std::array<bool, 2> axes{};             ///< x, y
  MoveCase move = {};                     ///< without motions, the nodes stay where they are
  fem::Point about = fem::Point::Zero();  ///< in the mesh as drawn [m]
  int about_node = -1;                    ///< the node that `about` is; -1: it is none, and stays where it is

  [[nodiscard]] Target target() const;
  /// Displacement from one load parameter to another of a node that was at `x` when the stage began, where the centre
  /// of the motion was at `centre` [m].
  [[nodiscard]] fem::Point displacement(const fem::Point& x, double from, double to, const fem::Point& centre) const;
  /// The same in the mesh as drawn.
  [[nodiscard]] fem::Point displacement(const fem::Point& x, double from, double to) const {
    return displacement(x, from, to, about);
  }
};

/// Loads of a boundary at the start and at the end of a stage; each axis has its own, because one may be held.
struct BoundaryLoad {
  std::string boundary = {};                             ///< empty: the edges without a name
  std::vector<fem::Edge> edges = {};                     ///< those of elements that are not dug out
  std::array<double, 2> pressure_from{}, pressure_to{};  ///< [Pa]
  std::array<double, 2> traction_from{}, traction_to{};  ///< [Pa]
  std::array<double, 2> rest_from{}, rest_to{};          ///< share of the tractions of ground at rest [-]
};

/// Degrees of freedom of a boundary or a point that a stage releases.
struct Released {
  std::set<int> own = {};     ///< those that it owned and that no holder before it takes back: their forces fade
  std::set<int> others = {};  ///< those of another owner, whom they stay with or go back to
};

/// One stage with everything that earlier stages have left.
struct StagePlan {
  StageCase input = {};
  std::vector<double> targets = {};  ///< load parameters of its increments
  std::vector<Holder> holders = {};  ///< in the order of the owner rule: the last that names an axis of a node owns it
  std::map<int, std::size_t> owners = {};  ///< degree of freedom -> index of its holder
  std::vector<int> idle_nodes = {};        ///< of no element that is left
  std::vector<BoundaryLoad> loads = {};
  double gravity_from = 0, gravity_to = 0;  ///< load factor of the weights [-]
  double tilt_from = 0, tilt_to = 0;        ///< [rad]
  std::vector<char> dug_out = {};           ///< as fem::Mesh::dug_out, from the start of the stage on
  /// Degrees of freedom whose forces fade in this stage, and the share of the force that is taken off: those that
  /// nothing holds any more, and those of the edge of what is dug out.
  std::map<int, double> fading = {};
  /// Degrees of freedom of what was released in part, now or before: the rest of their forces stays.
  std::map<Target, std::set<int>> part_released = {};
  std::map<Target, Released> released = {};  ///< in this stage

  /// The load of a boundary, or of the edges without a name (""); null where the boundary has no outer edges at all.
  [[nodiscard]] const BoundaryLoad* load_of(const std::string& boundary) const;
  [[nodiscard]] bool changes_gravity() const { return gravity_from != gravity_to || tilt_from != tilt_to; }
};

/// The stages of the scene in their order. Throws std::runtime_error, whose text begins with the key at fault, where
/// the nouns of the scene do not fit its mesh: nothing holds the ground along an axis, a press acts on what is held,
/// ...
[[nodiscard]] std::vector<StagePlan> plan_stages(const Scene& scene);

/// Load parameters of a stage in which the load factor of the weights grows by `rise`. `carried` is the vertical stress
/// at its start over the one of the full weights [-].
[[nodiscard]] std::vector<double> gravity_targets(const GravityCase& gravity, double carried, double rise);

/// The largest vertical stress of the weights at load factor 1: of the heaviest region over the height of the mesh
/// [Pa].
[[nodiscard]] double weight_stress(const Scene& scene);

/// The name of a boundary or of a point; a point without a name is called by its place in the mesh as drawn.
[[nodiscard]] std::string name_of(const fem::Mesh& mesh, const Holder& holder);
[[nodiscard]] std::string name_of(const fem::Mesh& mesh, const ReleaseCase& release);

/// The node of a point or of coordinates that lie on a node; -1 where there is none within 1e-6 of the mesh's size.
[[nodiscard]] int node_at(const fem::Mesh& mesh, const PlaceCase& place);
[[nodiscard]] Target target_of(const fem::Mesh& mesh, const ReleaseCase& release);
/// The outer edges of a named boundary; none of a curve inside the ground.
[[nodiscard]] const std::vector<fem::Edge>& outer_edges(const fem::Mesh& mesh, const std::string& boundary);
/// The coordinates of a place [m].
[[nodiscard]] fem::Point coordinates_of(const fem::Mesh& mesh, const PlaceCase& place);

}  // namespace voussoir::host
