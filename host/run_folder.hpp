#pragma once
/// The folder of a run, looked at before anything is written.

#include <filesystem>
#include <string>

#include "host/case.hpp"

namespace voussoir::host {

struct RunOptions {
  std::filesystem::path folder;  ///< of the results
  bool resume = false;           ///< go on from the last checkpoint
  bool replace = false;          ///< results of an earlier run may be removed
  std::string command;           ///< command line, for the record
  int threads = 1;
};

/// Throws io::InputError where the run must not start: the folder holds results and neither resume nor replace is asked
/// for; it holds other files and no results; or resume is asked for and the results belong to another case.
void check_folder(const RunOptions& options, const Case& input);

}  // namespace voussoir::host
