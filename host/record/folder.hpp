#pragma once
/// The folder of a run, looked at before anything is written.

#include <filesystem>
#include <string>

#include "host/case/case.hpp"

namespace voussoir::host {

struct RunOptions {
  std::filesystem::path folder;  ///< of the results
  bool resume = false;           ///< go on from the last checkpoint
  bool replace = false;          ///< results of an earlier run may be removed
  std::string command;           ///< command line, for the record
  int threads = 1;
};

/// Throws io::InputError where the run must not start: the folder holds results and neither resume nor replace is asked
/// for; it holds other files and no results; or resume is asked for and the results belong to another case. What a run
/// leaves that was killed before it had a run.h5 is no obstacle.
void check_folder(const RunOptions& options, const Case& input);

/// For options.replace: removes all that a run of any kind leaves in options.folder, checked before by check_folder.
void remove_earlier_run(const RunOptions& options);

}  // namespace voussoir::host
