#pragma once
/// A stage of a run: its loads, and the reports and checkpoint data that no other stage has.

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
  std::string name;  ///< the stage's name in docs/reference/files.md
  fem::Kinematics kinematics = fem::Kinematics::fixed_mesh;
  fem::LoadPath path;
  std::vector<double> targets;  ///< load parameters of all its increments, ascending from 0
  bool last = false;            ///< true where the whole run ends with this stage

  std::function<void(const fem::ConvergedStep&)> on_step;  ///< receives every converged step, also parts of a cut one;
                                                           ///< may be empty
  std::function<void(IncrementReport&)> on_record;         ///< adds the reports of the stage itself; may be empty
  std::function<void(io::Checkpoint&)> on_checkpoint;      ///< adds the data that the stage itself keeps; may be empty
};

}  // namespace voussoir::host
