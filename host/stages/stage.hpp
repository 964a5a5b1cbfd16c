#pragma once
/// A stage of a run: its loads, and what it alone reports and remembers.

#include <functional>
#include <string>
#include <vector>

#include "fem/load_stepper.hpp"
#include "host/record/increment_report.hpp"
#include "io/checkpoint.hpp"

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
  bool last = false;            ///< the whole run is finished with this stage

  std::function<void(const fem::ConvergedStep&)> on_step;  ///< sees every converged step, cut ones too; may be empty
  std::function<void(IncrementReport&)> on_record;         ///< adds what the stage itself reports; may be empty
  std::function<void(io::Checkpoint&)> on_checkpoint;      ///< adds what the stage itself remembers; may be empty
};

}  // namespace voussoir::host
