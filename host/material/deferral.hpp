#pragma once
/// An RVE whose stress hardly changes is deferred: the tangent of its grains' last run answers in place of the grains
/// (`engine.defer`).
///
/// Let F = R U be the deformation gradient since that run, e = log U, and let sigma_g, p_g and D be the stress, the
/// pressure and the tangent that the run found (the tangent of eq. (4) where the mesh asked for none). The deferred RVE
/// answers R (sigma_g + D : e) R^T. It may do so as long as
///     max(|D : e|, (D_xxxx + D_yyyy)/2 |e|) <= bound x trust x p_g
/// and for at most `most_commits` commits in a row. Otherwise its grains run, with the whole of F. An RVE is deferred
/// only if its grains came to rest under pressure. Once its grains run within an increment they run in every later
/// evaluation of that increment, so that the residual does not jump to and fro between iterates.
///
/// The bound limits the change of stress that is deferred. It does not limit the error of the answer: the tangent does
/// not show that grains are about to collapse, and the RVE keeps its stress from before the collapse until its grains
/// run. Each deferral therefore ends in a check: when the grains have run, their stress is compared with the stress
/// that the tangent gives for the same F. The error is the difference over p_g if the tangent might still have
/// answered. Beyond the bound, the part of the difference that belongs to the increment itself is left out, in
/// proportion to the change of stress. Where the error exceeds the bound, the trust in this RVE falls below 1; each
/// check that it passes doubles the trust again.

#include <cstddef>
#include <span>
#include <vector>

#include "fem/material_batch.hpp"
#include "kernels/state/rve_batch.hpp"

namespace voussoir::host {

/// The answer to a deformation gradient that follows from the grains' last run.
struct Extrapolation {
  fem::Stress stress;    ///< [Pa]
  fem::Tangent tangent;  ///< turned with the RVE [Pa]
  double change = 0;     ///< of the stress: the maximum above, which the bound limits [Pa]
};

/// @param gradient F - I since the run that `grains` reports
[[nodiscard]] Extrapolation extrapolate(const kernels::RveReport& grains, const fem::Gradient& gradient);

class Deferral {
 public:
  /// The most commits in a row without a run of the grains. The limit costs a sixteenth of the savings at the most, and
  /// it shows a wrong answer two or three load increments later.
  static constexpr int most_commits = 16;

  /// @param bound share of an RVE's pressure; with 0 no RVE is deferred and nothing is stored
  /// @param pressure_floor an RVE of less pressure is not deferred [Pa]
  Deferral(double bound, double pressure_floor) : bound_(bound), pressure_floor_(pressure_floor) {}

  [[nodiscard]] bool on() const { return bound_ > 0; }
  [[nodiscard]] double bound() const { return bound_; }

  /// The part of an RVE's record that is kept from increment to increment.
  struct Committed {
    fem::Gradient gradient = fem::Gradient::Zero();  ///< F - I since the last run of the grains, which have not
                                                     ///< followed it yet
    kernels::RveReport grains;                       ///< report of that run
    double trust = 1;                                ///< share of the bound that this RVE is granted
    int commits = 0;                                 ///< commits since the grains ran
  };

  /// Begins with RVEs whose grains have all just run and gave these reports.
  void start(std::span<const kernels::RveReport> grains);
  void begin_increment();

  /// F - I since the grains' last run, if this increment's displacement gradient is `h`.
  [[nodiscard]] fem::Gradient whole(std::size_t rve, const fem::Gradient& h) const;

  /// If the RVE may be deferred, writes a report of 0 steps in place of the grains' report and returns true. Otherwise
  /// returns false: its grains have to run with `whole`.
  bool answer(std::size_t rve, const fem::Gradient& h, kernels::RveReport& report);

  [[nodiscard]] bool runs(std::size_t rve) const { return !on() || trial_[rve].runs; }

  /// Takes the error of the answers before from `report`, the report of the grains' run. There is no error if nothing
  /// was deferred.
  void check(std::size_t rve, const fem::Gradient& h, const kernels::RveReport& report);

  /// Commits the increment. Returns true if the grains did not run and their committed state has to stay as it is.
  bool commit(std::size_t rve, const fem::Gradient& h, const kernels::RveReport& report);

  /// The largest error over pressure that the runs of the last evaluation have shown [-].
  [[nodiscard]] double error() const;

  [[nodiscard]] Committed& committed(std::size_t rve) { return rves_[rve]; }
  [[nodiscard]] const Committed& committed(std::size_t rve) const { return rves_[rve]; }

 private:
  struct Trial {
    bool runs = false;  ///< true once its grains have run within the increment
    double error = 0;
  };

  [[nodiscard]] bool within_bound(const Committed& rve, double change) const;

  double bound_;
  double pressure_floor_;
  std::vector<Committed> rves_;
  std::vector<Trial> trial_;
};

}  // namespace voussoir::host
