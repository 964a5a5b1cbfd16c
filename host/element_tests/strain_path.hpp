#pragma once
/// Drives RVEs without a mesh: increments follow one another as the mesh would put them on a point.

#include <functional>
#include <span>
#include <string>

#include "host/case/case.hpp"
#include "host/material/rve_pool.hpp"

namespace voussoir::host {

/// One RVE after one increment of a path.
struct PathPoint {
  std::size_t rve = 0;
  int increment = 0;      ///< 1, 2, ... over all segments
  int evaluations = 0;    ///< evaluations that this increment took
  kernels::Mat2 strain;   ///< log F since the path's start, extension positive [-]
  fem::Stress stress;     ///< tension positive [Pa]
  double void_ratio = 0;  ///< [-]
  const kernels::RveReport* report = nullptr;
};

/// How a path ended.
struct PathEnd {
  bool usable = true;
  std::string message;      ///< a sentence that says what failed and when; empty when usable
  int missed = 0;           ///< increments that end beyond `lateral_tolerance`, after `most_evaluations` evaluations
  double largest_miss = 0;  ///< over all RVEs and held increments: |sigma_xx - wanted| / |wanted| [-]
};

/// Takes all RVEs of `pool` along the segments, each increment by `evaluate` and `commit`. Where a segment holds
/// sigma_xx, each increment searches the gradient's xx at which sigma_xx has its value, to `lateral_tolerance` and with
/// at most `most_evaluations` evaluations. An increment that misses the value is counted; the next one aims at the same
/// value again.
/// @param scale a factor on the gradients of each RVE; replicas have slightly different factors
/// @param note called for each RVE after each increment
[[nodiscard]] PathEnd walk_path(RvePool& pool, std::span<const PathSegment> segments, std::span<const double> scale,
                                const std::function<void(const PathPoint&)>& note);

inline constexpr double lateral_tolerance = 5e-3;  ///< |sigma_xx - wanted| / |wanted| [-]
inline constexpr int most_evaluations = 10;

}  // namespace voussoir::host
