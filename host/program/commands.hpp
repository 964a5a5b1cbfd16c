#pragma once
/// The commands, called after the command line is parsed. They return exit codes and throw input errors.

#include <filesystem>
#include <string>
#include <vector>

#include "host/record/folder.hpp"

namespace voussoir::host {

/// `voussoir run`: checks case and folder before anything is written. Kokkos is initialised for the time of the run,
/// with options.threads; with 0 Kokkos chooses the number.
[[nodiscard]] int command_run(const std::filesystem::path& case_file, const std::vector<std::string>& overrides,
                              RunOptions options);

/// `voussoir check`: prints every value after defaults and overrides, and the estimated cost of the run.
[[nodiscard]] int command_check(const std::filesystem::path& case_file, const std::vector<std::string>& overrides);

/// `voussoir keys`: prints all keys of a kind with their types, defaults and limits.
[[nodiscard]] int command_keys(const std::string& kind);

/// `voussoir info`: prints where a result comes from, and its table of increments.
[[nodiscard]] int command_info(const std::filesystem::path& result_file);

struct SweepOptions {
  std::filesystem::path folder;
  std::filesystem::path program;  ///< this program, which is started once for each run
  int processes = 1;
  int threads = 0;
  bool resume = false;
};

/// `voussoir sweep`: runs one base case with different overrides, each run in a folder of its own, and writes
/// summary.csv.
[[nodiscard]] int command_sweep(const std::filesystem::path& sweep_file, const SweepOptions& options);

}  // namespace voussoir::host
