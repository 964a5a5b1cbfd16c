#pragma once
/// The program's commands: run, check, sweep, info.

namespace voussoir::host {

/// Parses and obeys the command line; returns an exit code of exit_code.hpp. Never throws.
[[nodiscard]] int run_command_line(int argc, char** argv);

}  // namespace voussoir::host
