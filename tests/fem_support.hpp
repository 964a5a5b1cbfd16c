#pragma once
/// Helpers of the finite-element tests: distorted meshes, and a nonlinear material with a tangent that is too stiff.

#include <cmath>
#include <functional>
#include <stdexcept>
#include <vector>

#include "fem/boundary.hpp"
#include "fem/linear_elastic.hpp"
#include "fem/load_stepper.hpp"
#include "fem/mesh_rectangle.hpp"

namespace voussoir::fem_support {

/// Every node moved by a map; positions given by a function of the undeformed ones.
inline fem::Mesh mapped(fem::Mesh mesh, const std::function<fem::Point(const fem::Point&)>& map) {
  for (auto x : mesh.coordinates.colwise()) x = map(fem::Point(x));
  return mesh;
}

/// A rectangle whose inner nodes, midsides included, are moved off their places: curved elements.
inline fem::Mesh distorted_rectangle(double width, double height, int nx, int ny, double amount) {
  return mapped(fem::make_rectangle(width, height, nx, ny), [=](const fem::Point& x) -> fem::Point {
    const double inside = std::sin(M_PI * x.x() / width) * std::sin(M_PI * x.y() / height);
    return {x.x() + amount * inside * std::sin(2 * x.y() + 0.3), x.y() + amount * inside * std::cos(3 * x.x())};
  });
}

/// Boundary nodes of a rectangle, each once.
inline std::vector<int> outline(const fem::Mesh& mesh) {
  std::vector<int> nodes;
  for (const char* name : {"base", "side", "top", "axis"})
    for (const int node : mesh.node_set(name))
      if (std::find(nodes.begin(), nodes.end(), node) == nodes.end()) nodes.push_back(node);
  return nodes;
}

struct SofteningOptions {
  double bulk = 1e7;             ///< K [Pa]
  double shear = 6e6;            ///< G at no strain [Pa]
  double strain_scale = 0.01;    ///< shear stress 2 G e / (1 + (e / scale)^power)
  double power = 1;              ///< 1: hardens for ever; above 1: softens past its peak
  double too_stiff = 1;          ///< the tangent returned is this times the elastic one
  double usable_strain = 1e300;  ///< a larger increment |F_rel - I| is not usable
  double noise = 0;              ///< reported as stress_noise [Pa]
  double unsettled = 0;          ///< reported as unsettled_stress [Pa]
};

/// Path-independent: stress from the total strain, the sum of the increments' sym(F_rel - I).
class SofteningMaterial : public fem::MaterialBatch {
 public:
  SofteningMaterial(std::size_t n, const SofteningOptions& options)
      : options_(options), committed_(n, Eigen::Vector3d::Zero()), trial_(committed_) {}

  [[nodiscard]] std::size_t size() const override { return committed_.size(); }
  void begin_increment() override { ++increments_begun; }

  fem::BatchReport evaluate(std::span<const fem::Gradient> gradients, std::span<fem::Stress> stress,
                            std::span<fem::Tangent> tangent) override {
    ++evaluations;
    fem::BatchReport report;
    report.work = size();
    report.lane_steps = 3 * size();
    report.tangent_time = tangent.empty() ? 0 : 2;  // by far more than an evaluation takes here
    report.stress_noise = options_.noise;
    report.unsettled_stress = options_.unsettled;
    for (std::size_t i = 0; i < size(); ++i) {
      const fem::Gradient& h = gradients[i];
      trial_[i] = committed_[i] + Eigen::Vector3d(h(0, 0), h(1, 1), h(0, 1) + h(1, 0));
      stress[i] = stress_of(trial_[i]);
      if (!tangent.empty()) tangent[i] = options_.too_stiff * elastic();
      if (!(h.norm() <= options_.usable_strain)) {
        report.usable = false;
        report.message = "point " + std::to_string(i) + " was strained too far";
      }
    }
    return report;
  }
  void commit() override { committed_ = trial_; }
  void committed(std::span<fem::Stress> stress, std::span<fem::Tangent> tangent) const override {
    for (std::size_t i = 0; i < size(); ++i) {
      stress[i] = stress_of(committed_[i]);
      if (!tangent.empty()) tangent[i] = options_.too_stiff * elastic();
    }
  }
  [[nodiscard]] std::vector<fem::PointField> fields() const override { return {}; }
  [[nodiscard]] std::vector<std::byte> state() const override {
    const auto* first = reinterpret_cast<const std::byte*>(committed_.data());
    return {first, first + size() * sizeof(Eigen::Vector3d)};
  }
  void set_state(std::span<const std::byte> bytes) override {
    if (bytes.size() != size() * sizeof(Eigen::Vector3d)) throw std::runtime_error("another batch");
    std::copy(bytes.begin(), bytes.end(), reinterpret_cast<std::byte*>(committed_.data()));
  }

  int evaluations = 0;
  int increments_begun = 0;

 private:
  [[nodiscard]] fem::Tangent elastic() const {
    fem::Tangent d = fem::Tangent::Zero();
    d(0, 0) = d(1, 1) = options_.bulk + options_.shear;
    d(0, 1) = d(1, 0) = options_.bulk - options_.shear;
    d(2, 2) = options_.shear;
    return d;
  }
  [[nodiscard]] fem::Stress stress_of(const Eigen::Vector3d& strain) const {
    const double mean = 0.5 * (strain[0] + strain[1]);
    const Eigen::Vector3d deviator(strain[0] - mean, strain[1] - mean, 0.5 * strain[2]);  // tensor components
    const double e = std::sqrt(deviator[0] * deviator[0] + deviator[1] * deviator[1] + 2 * deviator[2] * deviator[2]);
    const double secant = 2 * options_.shear / (1 + std::pow(e / options_.strain_scale, options_.power));
    const double pressure = 2 * options_.bulk * mean;
    return {pressure + secant * deviator[0], pressure + secant * deviator[1], secant * deviator[2]};
  }

  SofteningOptions options_;
  std::vector<Eigen::Vector3d> committed_;
  std::vector<Eigen::Vector3d> trial_;
};

}  // namespace voussoir::fem_support
