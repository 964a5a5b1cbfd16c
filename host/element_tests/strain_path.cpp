#include "host/element_tests/strain_path.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "host/material/deformation.hpp"

namespace voussoir::host {

namespace {

/// Searches the gradient's xx at which sigma_xx has its wanted value, by secants. Their slope is kept between the
/// contact tangent, which is stiff, and a small share of it, as yielding packings have.
class LateralSearch {
 public:
  LateralSearch(double first, double wanted) : x_(first), wanted_(wanted) {}

  [[nodiscard]] double gradient() const { return x_; }
  [[nodiscard]] bool found() const { return found_; }
  [[nodiscard]] double miss() const { return std::abs(miss_); }  ///< of the last evaluation, over the wanted stress [-]

  /// @param longest largest change of the gradient in one go [-]
  void see(double stress, double tangent, double longest) {
    const double error = stress - wanted_;
    miss_ = error / wanted_;
    found_ = std::abs(error) <= lateral_tolerance * std::abs(wanted_);
    if (found_) return;
    double slope = seen_ && x_ != x_before_ ? (error - error_before_) / (x_ - x_before_) : 0.5 * tangent;
    slope = std::clamp(slope, softest * tangent, tangent);
    x_before_ = x_;
    error_before_ = error;
    seen_ = true;
    // A packing without contacts has no tangent; it is compressed until it has contacts.
    x_ -= tangent > 0 ? std::clamp(error / slope, -longest, longest) : longest;
  }

 private:
  static constexpr double softest = 0.05;
  double x_, wanted_;
  double x_before_ = 0, error_before_ = 0, miss_ = 0;
  bool seen_ = false, found_ = false;
};

fem::Gradient gradient_of(const PathSegment& segment, double scale) {
  fem::Gradient h;
  h << segment.gradient[0], segment.gradient[1], segment.gradient[2], segment.gradient[3];
  return scale * h;
}

/// The state of all RVEs along the path.
struct Walk {
  RvePool& pool;
  std::vector<fem::Gradient> gradients;
  std::vector<fem::Stress> stress;
  std::vector<fem::Tangent> tangent;
  std::vector<kernels::Mat2> f;  ///< deformation gradient since the path's start
  std::vector<double> wanted;    ///< sigma_xx where it is held [Pa]
  std::vector<double> lateral;   ///< gradient's xx over its norm in the last increment

  explicit Walk(RvePool& rves)
      : pool(rves),
        gradients(rves.size()),
        stress(rves.size()),
        tangent(rves.size()),
        f(rves.size(), kernels::identity2),
        wanted(rves.size()),
        lateral(rves.size()) {
    pool.committed(stress, tangent);
  }
};

struct IncrementEnd {
  fem::BatchReport report;
  int evaluations = 0;
  double miss = 0;  ///< the largest deviation of sigma_xx where it was held [-]
};

IncrementEnd evaluate_given(Walk& walk) {
  IncrementEnd end;
  end.report = walk.pool.evaluate(walk.gradients, walk.stress, walk.tangent);
  end.evaluations = 1;
  return end;
}

IncrementEnd evaluate_held(Walk& walk) {
  std::vector<LateralSearch> searches;
  std::vector<double> size;
  for (std::size_t k = 0; k < walk.pool.size(); ++k) {
    size.push_back(walk.gradients[k].norm());
    searches.emplace_back(walk.lateral[k] * size[k], walk.wanted[k]);
  }
  IncrementEnd end;
  while (end.evaluations < most_evaluations) {
    for (std::size_t k = 0; k < searches.size(); ++k) walk.gradients[k](0, 0) = searches[k].gradient();
    end.report = walk.pool.evaluate(walk.gradients, walk.stress, walk.tangent);
    ++end.evaluations;
    if (!end.report.usable) break;
    for (std::size_t k = 0; k < searches.size(); ++k)
      searches[k].see(walk.stress[k](0), walk.tangent[k](0, 0), size[k]);
    if (std::all_of(searches.begin(), searches.end(), [](const LateralSearch& s) { return s.found(); })) break;
  }
  for (std::size_t k = 0; k < searches.size(); ++k) {
    walk.lateral[k] = walk.gradients[k](0, 0) / size[k];
    end.miss = std::max(end.miss, searches[k].miss());
  }
  return end;
}

void note_all(const Walk& walk, int increment, int evaluations, const std::function<void(const PathPoint&)>& note) {
  for (std::size_t k = 0; k < walk.pool.size(); ++k) {
    note({.rve = k,
          .increment = increment,
          .evaluations = evaluations,
          .strain = kernels::log_of(walk.f[k]),
          .stress = walk.stress[k],
          .void_ratio = walk.pool.void_ratio_of(k),
          .report = &walk.pool.committed_reports()[k]});
  }
}

}  // namespace

PathEnd walk_path(RvePool& pool, std::span<const PathSegment> segments, std::span<const double> scale,
                  const std::function<void(const PathPoint&)>& note) {
  Walk walk(pool);
  PathEnd end;
  int increment = 0;
  note_all(walk, increment, 0, note);
  for (const PathSegment& segment : segments) {
    for (std::size_t k = 0; k < pool.size(); ++k) walk.wanted[k] = walk.stress[k](0);
    std::fill(walk.lateral.begin(), walk.lateral.end(), 0.0);
    for (int k = 0; k < segment.increments; ++k) {
      for (std::size_t rve = 0; rve < pool.size(); ++rve) walk.gradients[rve] = gradient_of(segment, scale[rve]);
      pool.begin_increment();
      const IncrementEnd done = segment.constant_xx ? evaluate_held(walk) : evaluate_given(walk);
      ++increment;
      if (!done.report.usable) {
        end.usable = false;
        end.message = fmt::format("increment {} of the path: {}", increment, done.report.message);
        return end;
      }
      if (done.miss > lateral_tolerance) ++end.missed;
      end.largest_miss = std::max(end.largest_miss, done.miss);
      pool.commit();
      for (std::size_t rve = 0; rve < pool.size(); ++rve)
        walk.f[rve] = deformation_of(walk.gradients[rve]) * walk.f[rve];
      note_all(walk, increment, done.evaluations, note);
    }
  }
  return end;
}

}  // namespace voussoir::host
