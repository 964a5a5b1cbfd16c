#pragma once
/// Exit codes of the program.

namespace voussoir::host {

inline constexpr int exit_ok = 0;             ///< done, or nothing to do
inline constexpr int exit_input = 2;          ///< wrong input: one line on stderr, nothing written
inline constexpr int exit_numerical = 3;      ///< an increment did not converge; the last checkpoint stays
inline constexpr int exit_machine = 4;        ///< the machine failed: disk full, file vanished, no memory
inline constexpr int exit_interrupted = 130;  ///< Ctrl-C or SIGTERM: ended after an increment, can be resumed

}  // namespace voussoir::host
