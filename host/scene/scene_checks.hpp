#pragma once
/// Whether the nouns of a scene fit its mesh. All functions throw std::runtime_error, whose text begins with the key at
/// fault.

#include "host/scene/scene.hpp"

namespace voussoir::host {

/// The largest share of an element's edge by which a boundary may move in one step.
inline constexpr double most_of_an_edge = 0.25;
/// The share from which on `check` advises more steps.
inline constexpr double wide_step = 0.05;

/// Points of supports, moves and releases must be nodes, a press needs outer edges, a region is dug out once, and some
/// ground is left.
void check_places(const Scene& scene);

/// What the stage with this number releases is held, or was released in part, at ground that is left before it, and is
/// released once.
void check_releases(const fem::Mesh& mesh, const StageCase& stage, const std::vector<Holder>& holders,
                    const std::map<Target, std::set<int>>& part_released, std::size_t number);

/// The stage with this number: nothing presses on what is held or gone, motions of area keep to their supports, ground
/// at rest is level, no piece of the ground can move as a rigid body.
void check_stage(const Scene& scene, const StagePlan& plan, std::size_t number);

/// No step moves a boundary by more than most_of_an_edge.
void check_steps(const Scene& scene, const StagePlan& plan, std::size_t number);

/// Whether the outward normal of edges has a component along the axis somewhere.
[[nodiscard]] bool faces(const fem::Mesh& mesh, const std::vector<fem::Edge>& edges, int axis);

/// The shortest edge of an element, between its corners [m].
[[nodiscard]] double shortest_edge(const fem::Mesh& mesh, const fem::ElementNodes& element);

/// The largest motion of one step of a holder over the shortest edge of the elements at its nodes [-].
[[nodiscard]] double step_over_edge(const Scene& scene, const StagePlan& plan, const Holder& holder);

}  // namespace voussoir::host
