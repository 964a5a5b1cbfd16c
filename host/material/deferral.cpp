#include "host/material/deferral.hpp"

#include <algorithm>
#include <cmath>

#include "host/material/answers.hpp"
#include "host/material/deformation.hpp"
#include "kernels/contact/kinematics.hpp"

namespace voussoir::host {

namespace {

/// The matrix T with R sigma R^T = T sigma for sigma = (xx, yy, xy). A tangent D for engineering shears turns into T D
/// T^T.
fem::Tangent turning(double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  fem::Tangent t;
  t << c * c, s * s, -2 * c * s, s * s, c * c, 2 * c * s, c * s, -c * s, c * c - s * s;
  return t;
}

double norm_of(const fem::Stress& s) { return std::sqrt(s[0] * s[0] + s[1] * s[1] + 2 * s[2] * s[2]); }

void set_answer(const Extrapolation& from, kernels::RveReport& report) {
  report.stress[0] = from.stress[0];
  report.stress[1] = report.stress[2] = from.stress[2];
  report.stress[3] = from.stress[1];
  const fem::Tangent& d = from.tangent;
  const double upper[] = {d(0, 0), d(0, 1), d(0, 2), d(1, 1), d(1, 2), d(2, 2)};
  std::copy(std::begin(upper), std::end(upper), report.tangent);
}

}  // namespace

Extrapolation extrapolate(const kernels::RveReport& grains, const fem::Gradient& gradient) {
  const kernels::Mat2 f = deformation_of(gradient);
  const double angle = std::atan2(f.yx - f.xy, f.xx + f.yy);
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  const kernels::Mat2 strain = kernels::log_of(kernels::Mat2{c, s, -s, c} * f);
  const fem::Tangent d = tangent_of(grains);
  const fem::Stress change = d * fem::Stress(strain.xx, strain.yy, strain.xy + strain.yx);
  const fem::Tangent turn = turning(angle);
  return {turn * (stress_of(grains) + change), turn * d * turn.transpose(),
          std::max(norm_of(change), 0.5 * (d(0, 0) + d(1, 1)) * kernels::symmetric_norm(strain))};
}

void Deferral::start(std::span<const kernels::RveReport> grains) {
  if (!on()) return;
  rves_.assign(grains.size(), {});
  for (std::size_t k = 0; k < grains.size(); ++k) rves_[k].grains = grains[k];
  trial_.assign(grains.size(), {});
}

void Deferral::begin_increment() { std::fill(trial_.begin(), trial_.end(), Trial{}); }

fem::Gradient Deferral::whole(std::size_t rve, const fem::Gradient& h) const {
  if (!on()) return h;
  const fem::Gradient& before = rves_[rve].gradient;
  return h + before + h * before;  // this is F_rel F - I, written without cancellation
}

/// The comparisons are false for NaN, so that the grains run and report the failure.
bool Deferral::within_bound(const Committed& rve, double change) const {
  const double p = rve.grains.pressure();
  return rve.grains.status == kernels::RveStatus::converged && p > pressure_floor_ && change <= bound_ * rve.trust * p;
}

bool Deferral::answer(std::size_t rve, const fem::Gradient& h, kernels::RveReport& report) {
  if (runs(rve)) return false;
  const Extrapolation by_tangent = extrapolate(rves_[rve].grains, whole(rve, h));
  if (rves_[rve].commits >= most_commits || !within_bound(rves_[rve], by_tangent.change)) {
    trial_[rve].runs = true;
    return false;
  }
  report = rves_[rve].grains;
  report.steps = 0;
  set_answer(by_tangent, report);
  return true;
}

void Deferral::check(std::size_t rve, const fem::Gradient& h, const kernels::RveReport& report) {
  if (!on() || rves_[rve].commits == 0) return;
  const Committed& before = rves_[rve];
  const Extrapolation by_tangent = extrapolate(before.grains, whole(rve, h));
  const double deferred = extrapolate(before.grains, before.gradient).change;
  const bool comparable = within_bound(before, by_tangent.change) || deferred >= by_tangent.change;
  const double share = comparable ? 1.0 : deferred / by_tangent.change;
  trial_[rve].error = share * norm_of(stress_of(report) - by_tangent.stress) / before.grains.pressure();
}

bool Deferral::commit(std::size_t rve, const fem::Gradient& h, const kernels::RveReport& report) {
  Committed& at = rves_[rve];
  if (!runs(rve)) {
    at.gradient = whole(rve, h);
    ++at.commits;
    return true;
  }
  constexpr double least_trust = 1e-3;  // with this bound the trust is back at 1 after ten passed checks
  const double error = trial_[rve].error;
  at.trust = error > bound_ ? std::max(0.5 * at.trust * bound_ / error, least_trust) : std::min(1.0, 2 * at.trust);
  at.gradient.setZero();
  at.commits = 0;
  at.grains = report;
  return false;
}

double Deferral::error() const {
  double largest = 0;
  for (const Trial& trial : trial_) largest = std::max(largest, trial.error);
  return largest;
}

}  // namespace voussoir::host
