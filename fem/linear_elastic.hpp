#pragma once
/// Isotropic linear elasticity in plane strain as a batch, with which the finite-element part is verified on closed
/// forms.

#include "fem/material_batch.hpp"
#include "fem/retired_points.hpp"

namespace voussoir::fem {

enum class ElasticStrain {
  infinitesimal,  ///< sigma = sigma_n + D sym(F_rel - I)
  logarithmic     ///< sigma = R sigma_n R^T + D ln V with F_rel = V R, so that a rigid rotation only rotates the stress
};

struct ElasticOptions {
  double young = 1e7;                      ///< E [Pa], > 0
  double poisson = 0.3;                    ///< nu [-], -1 < nu < 0.5
  Stress initial_stress = Stress::Zero();  ///< at every point [Pa]
  ElasticStrain strain = ElasticStrain::infinitesimal;
};

/// Plane-strain stiffness on (xx, yy, gamma_xy) [Pa]. Throws std::invalid_argument outside the ranges above.
[[nodiscard]] Tangent plane_strain_stiffness(double young, double poisson);

class LinearElastic final : public MaterialBatch {
 public:
  /// Makes `n_points` points under `options.initial_stress`. Throws std::invalid_argument on impossible constants.
  LinearElastic(std::size_t n_points, const ElasticOptions& options);

  [[nodiscard]] std::size_t size() const override { return committed_.size(); }
  void begin_increment() override {}
  BatchReport evaluate(std::span<const Gradient> gradients, std::span<Stress> stress,
                       std::span<Tangent> tangent) override;
  void commit() override { committed_ = trial_; }
  void committed(std::span<Stress> stress, std::span<Tangent> tangent) const override;
  [[nodiscard]] std::vector<PointField> fields() const override { return {}; }
  [[nodiscard]] std::vector<std::byte> state() const override;
  void set_state(std::span<const std::byte> bytes) override;
  void retire(std::span<const std::size_t> points) override { retired_.add(points); }

  /// Sets the committed stress point by point, e.g. to a geostatic state.
  void set_stress(std::span<const Stress> stress);

 private:
  Tangent stiffness_;
  ElasticStrain strain_;
  std::vector<Stress> committed_;
  std::vector<Stress> trial_;
  RetiredPoints retired_;
};

}  // namespace voussoir::fem
