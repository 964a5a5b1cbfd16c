#pragma once
/// The points of a material batch that have been dug out (MaterialBatch::retire).

#include <cstddef>
#include <limits>
#include <span>
#include <stdexcept>
#include <vector>

#include "fem/material_batch.hpp"

namespace voussoir::fem {

class RetiredPoints {
 public:
  /// None of `n` points has been dug out.
  explicit RetiredPoints(std::size_t n) : n_(n) {}

  /// Throws std::out_of_range where a point does not exist; then none of them is added.
  void add(std::span<const std::size_t> points) {
    for (const std::size_t p : points)
      if (p >= n_) throw std::out_of_range("a point is dug out that does not exist");
    if (!points.empty()) is_retired_.resize(n_, 0);
    for (const std::size_t p : points) {
      count_ += is_retired_[p] == 0 ? 1 : 0;
      is_retired_[p] = 1;
    }
  }

  [[nodiscard]] bool contains(std::size_t point) const { return count_ > 0 && is_retired_[point] != 0; }
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] std::size_t left() const { return n_ - count_; }  ///< points that have not been dug out

  /// Sets the stress and, where the span is not empty, the tangent of these points to 0.
  void clear(std::span<Stress> stress, std::span<Tangent> tangent) const {
    for (std::size_t p = 0; count_ > 0 && p < n_; ++p) {
      if (!contains(p)) continue;
      stress[p].setZero();
      if (!tangent.empty()) tangent[p].setZero();
    }
  }

  /// Sets the values of these points to NaN.
  void clear(std::vector<PointField>& fields) const {
    for (PointField& field : fields) {
      const auto width = static_cast<std::size_t>(field.components);
      for (std::size_t k = 0; count_ > 0 && k < field.values.size(); ++k)
        if (contains(k / width)) field.values[k] = std::numeric_limits<double>::quiet_NaN();
    }
  }

 private:
  std::size_t n_;
  std::size_t count_ = 0;
  std::vector<char> is_retired_;  ///< (point); empty as long as there are none
};

}  // namespace voussoir::fem
