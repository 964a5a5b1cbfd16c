#pragma once
/// Takes the ground through one stage: load increments to equilibrium, each of them recorded and checkpointed.

#include <functional>
#include <string>
#include <vector>

#include "fem/load_stepper.hpp"
#include "host/record/recorder.hpp"
#include "host/stages/ground.hpp"

namespace voussoir::host {

enum class RunStatus {
  finished,
  interrupted,  ///< a signal asked to stop; the last increment has its checkpoint
  failed        ///< an increment did not converge; the last converged one has its checkpoint
};

struct Stage {
  std::string name;  ///< of io/FORMAT.md
  fem::Kinematics kinematics = fem::Kinematics::fixed_mesh;
  fem::LoadPath path;
  std::vector<double> targets;  ///< load parameters of all its increments, ascending from 0
  bool last = false;            ///< the run is finished behind it
  bool loses_volume = false;    ///< the load parameter is V_l

  std::function<void(const fem::ConvergedStep&)> on_step;  ///< every converged step, cut ones included; may be empty
  std::function<void(io::IncrementInfo&)> on_record;       ///< adds columns to the table; may be empty
  std::function<void(io::Checkpoint&)> on_checkpoint;      ///< adds what the stage itself remembers; may be empty
};

/// Goes from ground.state.parameter through the targets beyond it. Numerical failure is a status; it is explained in
/// the log, and nothing that did not converge is recorded.
[[nodiscard]] RunStatus advance_stage(Ground& ground, const Stage& stage, RunRecorder& recorder);

[[nodiscard]] fem::NewtonOptions newton_options(const NewtonCase& newton);

/// Writes the ground as it stands as a result file.
void record_ground(const Ground& ground, const io::IncrementInfo& info, const Eigen::VectorXd& reactions,
                   RunRecorder& recorder);

}  // namespace voussoir::host
