#pragma once
/// The course of one RVE from its committed to its trial state, in double, the same for a lane of a group and for a
/// block: the motion of its cell, the steps at which its list is renewed and its state is judged, and its end.

#include <cmath>

#include "kernels/contact/pair_state.hpp"
#include "kernels/course/drives.hpp"
#include "kernels/course/run_scales.hpp"

namespace voussoir::kernels {

template <class DriveType>
struct RveCourse {
  using Drive = DriveType;

  int rve = -1;  ///< -1: none
  bool running = false;
  RveStatus status = RveStatus::converged;
  int steps = 0;
  int next_list_check = 0;  ///< step of the next look at displacements
  double unbalanced = 0;
  double overlap = 0;  ///< largest at the last measuring step [-]
  Drive drive;
  Mat2 rate;            ///< velocity gradient per step of the coming motion
  Mat2 e;               ///< exp(rate) - I
  Mat2 f_minus_i;       ///< since the last rebase
  double rotation = 0;  ///< sum of W per step since the committed state [rad]
};

/// Sets the velocity gradient of the coming motion, which is that of `step`.
template <class Drive>
KOKKOS_INLINE_FUNCTION void set_rate(RveCourse<Drive>& course, int step) {
  const Mat2 rate = course.drive.rate(step);
  if (rate == course.rate) return;
  course.rate = rate;
  course.e = exp_minus_identity(rate);
}

/// Rounds the numbers of the cell's motion into lane `l`, for the sweep.
template <class V, class Drive>
KOKKOS_INLINE_FUNCTION void round_motion(const RveCourse<Drive>& course, CellMotion<V>& m, std::size_t l) {
  using real = real_of<V>;
  m.f_xx[l] = static_cast<real>(course.f_minus_i.xx);
  m.f_xy[l] = static_cast<real>(course.f_minus_i.xy);
  m.f_yx[l] = static_cast<real>(course.f_minus_i.yx);
  m.f_yy[l] = static_cast<real>(course.f_minus_i.yy);
  m.e_xx[l] = static_cast<real>(course.e.xx);
  m.e_xy[l] = static_cast<real>(course.e.xy);
  m.e_yx[l] = static_cast<real>(course.e.yx);
  m.e_yy[l] = static_cast<real>(course.e.yy);
  m.rotation[l] = static_cast<real>(0.5 * (course.rate.yx - course.rate.xy));
  m.alive[l] = course.running ? real(1) : real(0);
}

/// Moves the cell, F <- exp(rate) F in double, while its rate stays as it is, and rounds its motion for the sweep. The
/// cell of a course that is not running stands still.
template <class V, class Drive>
KOKKOS_INLINE_FUNCTION void carry_cell(RveCourse<Drive>& course, int step, CellMotion<V>& m, std::size_t l) {
  using real = real_of<V>;
  if (!course.running) course.rate = course.e = Mat2{};
  course.f_minus_i = course.e + course.f_minus_i + course.e * course.f_minus_i;
  m.d_xy[l] = static_cast<real>(0.5 * (course.rate.xy + course.rate.yx));
  m.d_difference[l] = static_cast<real>(course.rate.yy - course.rate.xx);
  course.rotation += 0.5 * (course.rate.yx - course.rate.xy);
  if (course.running) course.steps = step + 1;
  round_motion(course, m, l);
}

/// As carry_cell, and sets the rate of the coming motion.
template <class V, class Drive>
KOKKOS_INLINE_FUNCTION void move_cell(RveCourse<Drive>& course, int step, CellMotion<V>& m, std::size_t l) {
  carry_cell(course, step, m, l);
  if (!course.running) return;
  set_rate(course, step + 1);
  round_motion(course, m, l);
}

/// What a look at the displacements says about the list. The last two states end the course; in the last one a grain
/// has moved by more than a mean diameter.
enum class ListState { valid, stale, not_finite, flown };

/// Whether two grains whose pair is not listed may meet before the next look. They may where 2 max|u| + |F - I| (R +
/// skin), extrapolated to the next look, reaches the skin.
/// @param largest max |u| [m]; @param fastest max |w| [m/step]; @param finite whether all displacements are finite
template <class Drive>
KOKKOS_INLINE_FUNCTION ListState look_at_list(RveCourse<Drive>& course, double largest, double fastest, bool finite,
                                              const RunScales& scales, int list_interval, int step) {
  const double per_step = 2.0 * fastest + course.rate.norm() * scales.reach;
  const double moved = 2.0 * largest + course.f_minus_i.norm() * scales.reach;
  const bool known = finite && std::isfinite(moved + per_step);
  // Fast grains are looked at every step.
  const int interval = per_step * list_interval > 0.25 * scales.skin ? 1 : list_interval;
  course.next_list_check = step + interval;
  if (known && moved + interval * per_step < scales.skin) return ListState::valid;
  course.steps = step;
  if (!known) return ListState::not_finite;
  return largest > scales.mean_diameter ? ListState::flown : ListState::stale;
}

/// overlap / (r_i + r_j) from e = -g/R^2.
[[nodiscard]] KOKKOS_INLINE_FUNCTION double relative_overlap(double e) {
  return 1.0 - std::sqrt(1.0 - (e < 1.0 ? e : 1.0));
}

/// Whether overlaps are looked at in this step. These steps are fixed, so that they do not depend on the RVEs in other
/// lanes.
[[nodiscard]] KOKKOS_INLINE_FUNCTION bool guards(const EngineSettings& settings, int step) {
  return step % settings.guard_interval == settings.guard_interval - 1;
}

/// Current cell matrix. @param reference that of the last rebase
template <class Drive>
[[nodiscard]] KOKKOS_INLINE_FUNCTION Mat2 current_cell(const RveCourse<Drive>& course, const Mat2& reference) {
  return plus_identity(course.f_minus_i) * reference;
}

/// The measurement of lane `l`. @param sums over one measuring sweep; @param cell the current one
template <class V>
[[nodiscard]] KOKKOS_INLINE_FUNCTION Measurement measurement_of(const SweepSums<V>& sums, std::size_t l,
                                                                const Mat2& cell, const RunScales& scales,
                                                                double pressure_floor) {
  const double v = cell.det() * scales.thickness;
  Measurement m;
  m.stress_xx = sums.stress_xx[l] / v;
  m.stress_yy = sums.stress_yy[l] / v;
  m.stress_xy = 0.5 * (sums.stress_xy[l] + sums.stress_yx[l]) / v;
  m.width = cell.xx;
  m.height = cell.yy;
  const double p = Kokkos::max(-0.5 * (m.stress_xx + m.stress_yy), pressure_floor);
  m.unbalanced = std::sqrt(static_cast<double>(sums.force_squared[l]) / scales.grains) /
                 (p * scales.thickness * scales.mean_diameter);
  return m;
}

/// The decision of a measuring step: `ended` keeps the state, `lost` gives it up.
enum class Outcome { running, ended, lost };

/// Sets the status of a course that ends. @param reference cell at the last rebase; @param seen receives the
/// measurement if the drive looks at this step
template <class V, class Drive>
KOKKOS_INLINE_FUNCTION Outcome judge(RveCourse<Drive>& course, int step, const EngineSettings& settings,
                                     const SweepSums<V>& sums, std::size_t l, const Mat2& reference,
                                     const RunScales& scales, Measurement& seen) {
  if (guards(settings, step)) {
    course.overlap = relative_overlap(static_cast<double>(sums.largest_measure[l]));
    if (!(course.overlap <= settings.overlap_limit)) {
      course.status = RveStatus::overlap_limit;
      return Outcome::lost;
    }
  }
  if (!course.drive.looks(step)) return Outcome::running;
  seen = measurement_of(sums, l, current_cell(course, reference), scales, settings.pressure_floor);
  course.unbalanced = seen.unbalanced;
  const Verdict verdict = course.drive.judge(step, seen);
  if (verdict == Verdict::running) return Outcome::running;
  course.status = verdict == Verdict::converged ? RveStatus::converged : RveStatus::step_limit;
  return Outcome::ended;
}

}  // namespace voussoir::kernels
