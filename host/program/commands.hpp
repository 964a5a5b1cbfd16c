#pragma once
/// The commands, once the command line is parsed. They return exit codes and throw input errors.

#include <filesystem>
#include <string>
#include <vector>

#include "host/record/folder.hpp"

namespace voussoir::host {

/// `voussoir run`: checks case and folder before anything is written. Initialises Kokkos with options.threads (0: its
/// own choice) for the time of the run.
[[nodiscard]] int command_run(const std::filesystem::path& case_file, const std::vector<std::string>& overrides,
                              RunOptions options);

/// `voussoir check`: every value after defaults and overrides, and the size of the run.
[[nodiscard]] int command_check(const std::filesystem::path& case_file, const std::vector<std::string>& overrides);

/// `voussoir info`: where a result comes from, and its table of increments.
[[nodiscard]] int command_info(const std::filesystem::path& result_file);

struct SweepOptions {
  std::filesystem::path folder;
  std::filesystem::path program;  ///< this program, started once a run
  int processes = 1;
  int threads = 0;
  bool resume = false;
};

/// `voussoir sweep`: runs of one base case with different overrides, each in a folder of its own, and summary.csv.
[[nodiscard]] int command_sweep(const std::filesystem::path& sweep_file, const SweepOptions& options);

}  // namespace voussoir::host
