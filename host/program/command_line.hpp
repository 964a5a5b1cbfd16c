#pragma once
/// The program's commands: run, check, sweep, info.

namespace voussoir::host {

/// Parses the command line and runs its command. Returns an exit code of exit_code.hpp and never throws.
[[nodiscard]] int run_command_line(int argc, char** argv);

}  // namespace voussoir::host
