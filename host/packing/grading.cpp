#include "host/packing/grading.hpp"

#include <algorithm>
#include <cstddef>

namespace voussoir::host {

namespace {

/// The grading curve as shares of the number of grains. Between two points of a curve by area the area is spread evenly
/// over sizes, so that the number of grains between d1 and d is proportional to 1/d1 - 1/d.
class GradingByNumber {
 public:
  explicit GradingByNumber(const SoilCase& soil)
      : by_area_(!soil.sizes.empty() && soil.passing_by == GradingMeasure::area) {
    sizes_ = soil.sizes.empty() ? std::vector<double>{soil.size_minimum, soil.size_maximum} : soil.sizes;
    const std::vector<double> passing = soil.sizes.empty() ? std::vector<double>{0.0, 1.0} : soil.passing;
    below_.assign(1, 0.0);
    for (std::size_t k = 1; k < sizes_.size(); ++k) {
      const double share = passing[k] - passing[k - 1];
      below_.push_back(below_.back() + (by_area_ ? share / (sizes_[k - 1] * sizes_[k]) : share));
    }
    for (double& n : below_) n /= below_.back();
  }

  /// The size below which a share `u` of all grains lies, 0 <= u <= 1 [m].
  [[nodiscard]] double size_at(double u) const {
    std::size_t k = 1;
    while (k + 1 < below_.size() && below_[k] <= u) ++k;
    const double part = (u - below_[k - 1]) / (below_[k] - below_[k - 1]);
    if (!by_area_) return sizes_[k - 1] + part * (sizes_[k] - sizes_[k - 1]);
    return 1.0 / (1.0 / sizes_[k - 1] - part * (1.0 / sizes_[k - 1] - 1.0 / sizes_[k]));
  }

 private:
  bool by_area_;
  std::vector<double> sizes_;
  std::vector<double> below_;  ///< share of the number of grains below each size
};

}  // namespace

std::vector<double> sample_radii(const SoilCase& soil, int grains, std::int64_t seed) {
  const GradingByNumber grading(soil);
  Uniform uniform(seed);
  std::vector<double> radii(static_cast<std::size_t>(grains));
  for (std::size_t k = 0; k < radii.size(); ++k) {
    radii[k] = 0.5 * grading.size_at((static_cast<double>(k) + uniform()) / grains);
  }
  std::sort(radii.rbegin(), radii.rend());
  return radii;
}

}  // namespace voussoir::host
