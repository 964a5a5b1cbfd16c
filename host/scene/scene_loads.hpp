#pragma once
/// The loads of a stage as a function of its load parameter.

#include "fem/load_path.hpp"
#include "host/scene/rest.hpp"
#include "host/scene/scene.hpp"
#include "host/stages/ground.hpp"

namespace voussoir::host {

/// Forces of supports that are gone and of ground that was dug out, as far as they act still. A checkpoint keeps both.
struct FadingForces {
  Eigen::VectorXd kept = {};    ///< of earlier stages; they stay [N/m]; empty: none
  Eigen::VectorXd fading = {};  ///< at the start of this stage; empty: none [N/m]
};

/// The loads of one stage. It keeps references to all that it is made of.
class SceneLoads {
 public:
  /// @param rest null where nothing is pressed at rest
  SceneLoads(const Scene& scene, const StagePlan& plan, const Ground& ground, const GroundAtRest* rest)
      : scene_(scene), plan_(plan), ground_(ground), rest_(rest) {}

  /// Weights, pressures and tractions at a load parameter, without fading forces [N/m].
  [[nodiscard]] Eigen::VectorXd of_stage(double parameter) const;

  /// Takes over what the stage before has left of its fading forces, and finds those of this stage: the forces that are
  /// missing at its start where nothing holds any more. To be called when the ground has begun the stage.
  void begin(const StagePlan* before, FadingForces& forces) const;

  /// The path of the stage. `forces` must outlive it.
  [[nodiscard]] fem::LoadPath path(const FadingForces& forces) const;

  /// Forces of all supports on the ground, n_dofs, zero where nothing holds: of the state committed, with the loads at
  /// `parameter` [N/m].
  [[nodiscard]] Eigen::VectorXd reactions(double parameter, const FadingForces& forces) const;

 private:
  [[nodiscard]] Eigen::VectorXd weights(double share) const;
  void add_load(const BoundaryLoad& load, double share, Eigen::VectorXd& force) const;
  [[nodiscard]] Eigen::VectorXd all_forces(double parameter, const FadingForces& forces) const;
  /// Takes off what earlier stages have left where the ground is held again, where the forces fade now, and where no
  /// ground is left.
  void drop_kept(Eigen::VectorXd& kept) const;
  [[nodiscard]] Eigen::VectorXd internal_force() const;
  [[nodiscard]] fem::Constraints increment(double from, double to) const;
  [[nodiscard]] double share_of(double parameter) const { return parameter / plan_.input.end; }

  const Scene& scene_;
  const StagePlan& plan_;
  const Ground& ground_;
  const GroundAtRest* rest_;
  mutable double cached_share_ = -1;
  mutable Eigen::VectorXd cached_weights_;
};

}  // namespace voussoir::host
