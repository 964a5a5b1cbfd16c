#pragma once
/// One stage while it runs. From the steps of the load stepper it makes the reports of increments, which are recorded,
/// and the totals of the stage.

#include <chrono>

#include "fem/load_stepper.hpp"
#include "host/stages/ground_run.hpp"
#include "host/stages/stage.hpp"

namespace voussoir::host {

class StageRun {
 public:
  /// Keeps references to the run and to the stage.
  StageRun(GroundRun& run, const Stage& stage);

  /// The number of targets of the stage that the ground has reached.
  [[nodiscard]] int done() const { return done_; }

  /// Accepts a converged step. At a target the increment is recorded. Returns false where the run has to stop there.
  [[nodiscard]] bool converged(const fem::ConvergedStep& step);

  /// Counts and logs a step that did not converge.
  void failed(const fem::FailedStep& step);

  /// Waits until all increments are on the disk, and adds the wall time since the last one to the totals: it went into
  /// this waiting and into steps that did not complete an increment.
  void end();

 private:
  using Clock = std::chrono::steady_clock;

  /// The effort since the last target, summed over the steps to the next one and over steps that were cut.
  struct Effort {
    int iterations = 0;
    int evaluations = 0;
    int cuts = 0;
    double particle_steps = 0;
    int relaxations = 0;
    double viscous_work = 0;    ///< [J/m]
    double deferral_error = 0;  ///< the largest [-]
    fem::PartTimes times;
    Clock::time_point since = Clock::now();
  };

  void tally(const fem::NewtonReport& report);
  void finish_increment(const fem::ConvergedStep& step, bool stop);
  [[nodiscard]] IncrementReport report_of(const fem::ConvergedStep& step) const;
  [[nodiscard]] EquilibriumReport equilibrium_of(const fem::NewtonReport& report) const;
  void add_to_totals(const IncrementReport& increment);
  void add_checkpoint(bool finished);

  GroundRun& run_;
  const Stage& stage_;
  int done_ = 0;
  Effort effort_;
  double output_ = 0;  ///< wall time that the last increment waited for output [s]
};

}  // namespace voussoir::host
