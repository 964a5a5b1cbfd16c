#pragma once
/// RVEs whose stress hardly changes answer by the tangent of their grains' last run instead of by their grains
/// (`engine.defer`).
///
/// F = R U is the deformation gradient since that run, sigma_g and D its stress and tangent (eq. (4) where the
/// mesh asked for none), e = log U. The answer is
/// R (sigma_g + D : e) R^T, as long as max(|D : e|, (D_xxxx + D_yyyy)/2 |e|) <= bound x trust x p_g and no more than
/// `most_commits` commits in a row; else the grains run with the whole of F. Only an RVE whose grains came to rest
/// under pressure is deferred. Once it runs within an increment it runs to the increment's end, so that the residual
/// does not jump to and fro between iterates.
///
/// This bounds what is deferred, not by how much the answer is off: grains that are about to collapse do not show it in
/// their tangent, and their stress stays that before the collapse until they run. So every deferral ends in a check:
/// the grains' answer against what the tangent makes of the same F. Their difference over p_g is the error, where the
/// tangent might still have answered; beyond, the increment's own share of the difference is left out, in proportion of
/// the stress' change. Where the error exceeds the bound the RVE's trust falls below 1, and doubles with every check
/// passed.

#include <cstddef>
#include <span>
#include <vector>

#include "fem/material_batch.hpp"
#include "kernels/state/rve_batch.hpp"

namespace voussoir::host {

/// What the grains' last run makes of a deformation gradient.
struct Extrapolation {
  fem::Stress stress;    ///< [Pa]
  fem::Tangent tangent;  ///< turned with the RVE [Pa]
  double change = 0;     ///< of the stress, as bounded above [Pa]
};

/// @param gradient F - I since the run that `grains` reports
[[nodiscard]] Extrapolation extrapolate(const kernels::RveReport& grains, const fem::Gradient& gradient);

class Deferral {
 public:
  /// In a row. Costs a sixteenth of the savings at the most, and shows a wrong answer two or three load increments
  /// later.
  static constexpr int most_commits = 16;

  /// @param bound share of an RVE's pressure, 0: no RVE is deferred and nothing is stored; @param pressure_floor below
  /// which none is deferred [Pa]
  Deferral(double bound, double pressure_floor) : bound_(bound), pressure_floor_(pressure_floor) {}

  [[nodiscard]] bool on() const { return bound_ > 0; }
  [[nodiscard]] double bound() const { return bound_; }

  /// What of an RVE outlives an increment.
  struct Committed {
    fem::Gradient gradient = fem::Gradient::Zero();  ///< F - I since the grains ran; what the grains have yet to be
                                                     ///< given
    kernels::RveReport grains;                       ///< of that run
    double trust = 1;                                ///< share of the bound that this RVE is granted
    int commits = 0;                                 ///< since the grains ran
  };

  /// All grains have just run, with these answers.
  void start(std::span<const kernels::RveReport> grains);
  void begin_increment();

  /// F - I that the grains would be given for this increment's `h`.
  [[nodiscard]] fem::Gradient whole(std::size_t rve, const fem::Gradient& h) const;

  /// Answers for the grains, with 0 steps, if it may; false: they have to run with `whole`.
  bool answer(std::size_t rve, const fem::Gradient& h, kernels::RveReport& report);

  [[nodiscard]] bool runs(std::size_t rve) const { return trial_[rve].runs; }

  /// The grains ran and answered `report`; nothing was deferred before: no error.
  void check(std::size_t rve, const fem::Gradient& h, const kernels::RveReport& report);

  /// Takes the increment over. True: the grains did not run, their state is still the committed one.
  bool commit(std::size_t rve, const fem::Gradient& h, const kernels::RveReport& report);

  /// Largest error over pressure that the grains' runs of the last evaluation have shown [-]
  [[nodiscard]] double error() const;

  [[nodiscard]] Committed& committed(std::size_t rve) { return rves_[rve]; }
  [[nodiscard]] const Committed& committed(std::size_t rve) const { return rves_[rve]; }

 private:
  struct Trial {
    bool runs = false;  ///< its grains, until the increment ends
    double error = 0;
  };

  [[nodiscard]] bool within_bound(const Committed& rve, double change) const;

  double bound_;
  double pressure_floor_;
  std::vector<Committed> rves_;
  std::vector<Trial> trial_;
};

}  // namespace voussoir::host
