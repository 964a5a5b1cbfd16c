#include "fem/linear_elastic.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace voussoir::fem {

namespace {

Eigen::Matrix2d tensor(const Stress& s) {
  Eigen::Matrix2d m;
  m << s[0], s[2], s[2], s[1];
  return m;
}

/// Trial stress after F_rel = V R: the committed stress turned by R plus D ln V.
Stress logarithmic_stress(const Tangent& stiffness, const Stress& committed, const Gradient& h) {
  const Eigen::Matrix2d f = Eigen::Matrix2d::Identity() + h;
  // ln V = 1/2 ln(F F^T) through its spectrum; R = V^-1 F.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> spectrum(f * f.transpose());
  const Eigen::Vector2d stretch = spectrum.eigenvalues().cwiseSqrt();
  const Eigen::Matrix2d& q = spectrum.eigenvectors();
  const Eigen::Matrix2d log_v = q * stretch.array().log().matrix().asDiagonal() * q.transpose();
  const Eigen::Matrix2d rotation = q * stretch.cwiseInverse().asDiagonal() * q.transpose() * f;
  const Eigen::Matrix2d turned = rotation * tensor(committed) * rotation.transpose();
  const Stress start(turned(0, 0), turned(1, 1), 0.5 * (turned(0, 1) + turned(1, 0)));
  return start + stiffness * Eigen::Vector3d(log_v(0, 0), log_v(1, 1), log_v(0, 1) + log_v(1, 0));
}

}  // namespace

Tangent plane_strain_stiffness(double young, double poisson) {
  if (!(young > 0) || !std::isfinite(young)) throw std::invalid_argument("elastic: Young's modulus must be positive");
  if (!(poisson > -1 && poisson < 0.5))
    throw std::invalid_argument("elastic: Poisson's ratio must be between -1 and 0.5");
  const double scale = young / ((1 + poisson) * (1 - 2 * poisson));
  Tangent d = Tangent::Zero();
  d(0, 0) = d(1, 1) = scale * (1 - poisson);
  d(0, 1) = d(1, 0) = scale * poisson;
  d(2, 2) = scale * (1 - 2 * poisson) / 2;
  return d;
}

LinearElastic::LinearElastic(std::size_t n_points, const ElasticOptions& options)
    : stiffness_(plane_strain_stiffness(options.young, options.poisson)),
      strain_(options.strain),
      committed_(n_points, options.initial_stress),
      trial_(committed_),
      retired_(n_points) {
  if (!options.initial_stress.allFinite()) throw std::invalid_argument("elastic: the initial stress must be finite");
}

BatchReport LinearElastic::evaluate(std::span<const Gradient> gradients, std::span<Stress> stress,
                                    std::span<Tangent> tangent) {
  for (std::size_t i = 0; i < size(); ++i) {
    if (retired_.contains(i)) continue;
    const Gradient& h = gradients[i];
    if (strain_ == ElasticStrain::logarithmic)
      trial_[i] = logarithmic_stress(stiffness_, committed_[i], h);
    else
      trial_[i] = committed_[i] + stiffness_ * Eigen::Vector3d(h(0, 0), h(1, 1), h(0, 1) + h(1, 0));
    stress[i] = trial_[i];
  }
  std::fill(tangent.begin(), tangent.end(), stiffness_);
  retired_.clear(stress, tangent);
  return {};
}

void LinearElastic::committed(std::span<Stress> stress, std::span<Tangent> tangent) const {
  std::copy(committed_.begin(), committed_.end(), stress.begin());
  std::fill(tangent.begin(), tangent.end(), stiffness_);
  retired_.clear(stress, tangent);
}

std::vector<std::byte> LinearElastic::state() const {
  std::vector<std::byte> bytes(size() * sizeof(Stress));
  std::memcpy(bytes.data(), static_cast<const void*>(committed_.data()), bytes.size());
  return bytes;
}

void LinearElastic::set_state(std::span<const std::byte> bytes) {
  if (bytes.size() != size() * sizeof(Stress)) throw std::runtime_error("elastic: this state belongs to another batch");
  std::memcpy(static_cast<void*>(committed_.data()), bytes.data(), bytes.size());
  trial_ = committed_;
}

void LinearElastic::set_stress(std::span<const Stress> stress) {
  if (stress.size() != size()) throw std::invalid_argument("elastic: one stress for each point is needed");
  std::copy(stress.begin(), stress.end(), committed_.begin());
  trial_ = committed_;
}

}  // namespace voussoir::fem
