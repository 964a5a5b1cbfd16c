#pragma once
/// How one run of a sweep ended, in a file of its own, so that runs which were started by different programs on
/// different machines can be gathered.

#include <filesystem>
#include <optional>
#include <string>

namespace voussoir::io {

struct RunOutcome {
  std::string status;  ///< "finished", "no equilibrium", ...
  int exit_code = 0;   ///< 128 + signal where a signal ended the run
  std::string reason;  ///< last line of its standard error; empty where it said nothing
};

/// Throws std::runtime_error naming file and reason.
void write_outcome(const std::filesystem::path& file, const RunOutcome& outcome);

/// Nothing where there is no such file. Throws std::runtime_error where it is damaged.
[[nodiscard]] std::optional<RunOutcome> read_outcome(const std::filesystem::path& file);

}  // namespace voussoir::io
