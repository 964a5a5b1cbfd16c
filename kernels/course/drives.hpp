#pragma once
/// How a lane's cell is driven: a given motion (the ground) or stresses (consolidation, element tests).
///
/// A drive is a template argument of the time loop. `rate(step)` is the velocity gradient per step, `looks(step)` asks
/// for a measuring step, `judge(step, ...)` receives the measurement of such a step and says whether the lane is done.

#include <algorithm>
#include <cmath>

#include "kernels/course/run_scales.hpp"
#include "kernels/state/requests.hpp"

namespace voussoir::kernels {

/// Result of a measuring step for one lane.
struct Measurement {
  double stress_xx = 0, stress_yy = 0, stress_xy = 0;  ///< tension positive [Pa]
  double unbalanced = 0;                               ///< rms|f| / (max(p, floor) t d) [-]
  double width = 0, height = 0;                        ///< of a rectangular cell [m]
};

enum class Verdict { running, converged, step_limit };

/// Largest |L| per step with which lists stay valid: within one list interval the cell then moves the two grains of a
/// pair against each other by at most a twentieth of the skin.
[[nodiscard]] inline double largest_rate(const RunScales& scales, const EngineSettings& settings) {
  return 0.05 * scales.skin / (settings.list_interval * scales.reach);
}
[[nodiscard]] inline double largest_rate(const Packing& packing, const EngineSettings& settings) {
  return largest_rate(scales_of<PlainEngineLaw>(packing, settings), settings);
}

/// The cell moves by F(t) = exp(t log F_rel / n) for n steps, then rests until the forces balance.
class StrainDrive {
 public:
  using Request = StrainRequest;
  static constexpr bool can_record = false;

  StrainDrive() = default;
  StrainDrive(const StrainRequest& request, const RunScales& scales, const EngineSettings& settings)
      : interval_(settings.look_interval), tolerance_(settings.hold_tolerance), total_(log_of(request.f_rel)) {
    if (!possible()) return;
    const double fewest = std::ceil(total_.norm() / largest_rate(scales, settings));
    strain_steps_ = static_cast<int>(std::clamp(fewest, static_cast<double>(std::max(request.strain_steps, 0)), 1e9));
    last_ = strain_steps_ + std::max(request.hold_cap, 1) - 1;
    if (strain_steps_ > 0) rate_ = (1.0 / strain_steps_) * total_;
  }

  /// False for a motion without a real logarithm (NaN, det F <= 0); the RVE is then not run.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION bool possible() const { return std::isfinite(total_.norm()); }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION Mat2 rate(int step) const { return step < strain_steps_ ? rate_ : Mat2{}; }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION bool looks(int step) const {
    return step >= strain_steps_ && (step % interval_ == 0 || step >= last_);
  }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION double strain_rate() const { return symmetric_norm(rate_); }
  [[nodiscard]] const Mat2& heading() const { return total_; }  ///< the motion that a loading tangent goes on with

  KOKKOS_INLINE_FUNCTION Verdict judge(int step, const Measurement& m) {
    if (step < strain_steps_) return Verdict::running;
    if (m.unbalanced < tolerance_) return Verdict::converged;
    return step >= last_ ? Verdict::step_limit : Verdict::running;
  }

 private:
  int strain_steps_ = 0;
  int last_ = 0;
  int interval_ = 1;
  double tolerance_ = 0;
  Mat2 total_;
  Mat2 rate_;
};

/// PI control of each stress-controlled axis. Its reference modulus is the mean stiffness of the packing's contacts
/// over the thickness. The proportional part alone would leave an offset with stiff grains.
class ServoControl {
 public:
  using Request = ServoRequest;
  static constexpr bool can_record = false;

  ServoControl() = default;
  ServoControl(const ServoRequest& request, const RunScales& scales, const EngineSettings& settings)
      : request_(request),
        tolerance_(settings.hold_tolerance),
        floor_(settings.pressure_floor),
        modulus_(scales.mean_stiffness / scales.thickness) {
    request_.max_rate = std::min(request_.max_rate, largest_rate(scales, settings));
    rate_x_.value = request.x.stress_controlled ? 0.0 : request.x.target;
    rate_y_.value = request.y.stress_controlled ? 0.0 : request.y.target;
  }

  [[nodiscard]] KOKKOS_INLINE_FUNCTION bool possible() const {
    return std::isfinite(request_.x.target) && std::isfinite(request_.y.target);
  }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION Mat2 rate(int) const { return {rate_x_.value, 0, 0, rate_y_.value}; }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION bool looks(int) const { return true; }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION double strain_rate() const { return symmetric_norm(rate(0)); }
  [[nodiscard]] Mat2 heading() const { return rate(0); }

  KOKKOS_INLINE_FUNCTION Verdict judge(int step, const Measurement& m) {
    const bool x_ok = follow(request_.x, m.stress_xx, rate_x_);
    const bool y_ok = follow(request_.y, m.stress_yy, rate_y_);
    if (step == 0) start_ = m;
    if (std::abs(std::log(m.height / start_.height)) >= request_.end_strain_y) return Verdict::converged;
    const bool at_rest = request_.x.stress_controlled && request_.y.stress_controlled && m.unbalanced < tolerance_;
    settled_ = x_ok && y_ok && at_rest ? settled_ + 1 : 0;
    if (settled_ >= request_.settle_steps) return Verdict::converged;
    return step + 1 >= request_.max_steps ? Verdict::step_limit : Verdict::running;
  }

  /// Whether the caller wants a sample of this step, which `sample` makes; both are to be called after `judge`.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION bool samples(int step) const {
    return request_.trace != nullptr && step % request_.trace_interval == 0;
  }
  [[nodiscard]] KOKKOS_INLINE_FUNCTION ServoSample sample(int step, const Measurement& m) const {
    return {step,
            std::log(m.width / start_.width),
            std::log(m.height / start_.height),
            m.stress_xx,
            m.stress_yy,
            m.stress_xy,
            m.unbalanced};
  }

 protected:
  ServoRequest request_;

 private:
  static constexpr double proportional = 0.02;                            ///< share of the error per step
  static constexpr double integral = 0.25 * proportional * proportional;  ///< critical damping of the loop

  struct Rate {
    double value = 0;
    double sum = 0;
  };

  KOKKOS_INLINE_FUNCTION bool follow(const ServoAxis& axis, double stress, Rate& rate) const {
    if (!axis.stress_controlled) return true;
    const double error = (axis.target - stress) / modulus_;
    const double wanted = proportional * error + integral * (rate.sum + error);
    rate.value = Kokkos::clamp(wanted, -request_.max_rate, request_.max_rate);
    if (wanted == rate.value) rate.sum += error;  // the sum stands still while the rate is at its limit
    return std::abs(axis.target - stress) <= request_.stress_tolerance * Kokkos::max(std::abs(axis.target), floor_);
  }

  Measurement start_;
  double tolerance_ = 0;
  double floor_ = 0;
  double modulus_ = 1;
  Rate rate_x_, rate_y_;
  int settled_ = 0;
};

/// The control that also keeps the trace, and the contact network along the path, where the caller asks for them.
class ServoDrive : public ServoControl {
 public:
  static constexpr bool can_record = true;
  using ServoControl::ServoControl;

  /// Whether `record` must be called before the step's sweep. The sample that `judge` takes after the sweep holds the
  /// recorded microstructure.
  [[nodiscard]] bool records(int step) const { return request_.microstructure.any() && samples(step); }
  [[nodiscard]] const MicrostructureRequest& recorded_quantities() const { return request_.microstructure; }
  void record(const Microstructure& m) { recorded_ = m; }

  /// Runs on the host only; it is marked for host and device because its caller is.
  KOKKOS_INLINE_FUNCTION Verdict judge(int step, const Measurement& m) {
    const Verdict verdict = ServoControl::judge(step, m);
    KOKKOS_IF_ON_HOST((if (samples(step)) keep(sample(step, m));))
    return verdict;
  }

 private:
  Microstructure recorded_;

  void keep(const ServoSample& sample) {
    request_.trace->push_back(sample);
    request_.trace->back().microstructure = recorded_;
  }
};

}  // namespace voussoir::kernels
