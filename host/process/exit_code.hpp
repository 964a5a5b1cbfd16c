#pragma once
/// How the program ends: one table of outcomes and exit codes, which docs/reference/exit_status.md and `voussoir
/// --help` repeat, and the one function that makes a code of an outcome. host/case/failure.hpp makes an outcome of
/// an exception.

#include <array>
#include <stdexcept>

namespace voussoir::host {

enum class Outcome { done, wrong_input, no_equilibrium, machine_failure, interrupted };

struct ExitStatus {
  Outcome outcome;
  int code;
  const char* name;     ///< in the summary of a sweep
  const char* meaning;  ///< in README.md and in `--help`
};

inline constexpr std::array<ExitStatus, 5> exit_table{{
    {Outcome::done, 0, "finished", "the run is done, or there was nothing left to do"},
    {Outcome::wrong_input, 2, "wrong input",
     "the input has a fault, or another process holds the folder; one line names file, line and key, and no results "
     "are written"},
    {Outcome::no_equilibrium, 3, "no equilibrium",
     "the computation found no equilibrium: of an increment, of a packing, or a test that is not valid; the log says "
     "what, where and when, and the last good checkpoint is kept; or an ensemble misses the accuracy of --until"},
    {Outcome::machine_failure, 4, "machine failure",
     "the machine failed (disk, memory, a file that vanished), or the program has an error within; one line names file "
     "and reason, and --resume goes on when it is mended"},
    {Outcome::interrupted, 130, "interrupted",
     "Ctrl-C, SIGTERM, SIGHUP, SIGUSR1 or SIGXCPU stopped the run after an increment; --resume goes on"},
}};

[[nodiscard]] constexpr const ExitStatus& status_of(Outcome outcome) {
  for (const ExitStatus& status : exit_table) {
    if (status.outcome == outcome) return status;
  }
  throw std::logic_error("an outcome without exit code");
}

/// The exit code of the program for an outcome.
[[nodiscard]] constexpr int exit_code(Outcome outcome) { return status_of(outcome).code; }

/// A packing or a test that comes to no rest, where it ends the run: a property of the case, which another try would
/// not change. An increment without equilibrium is no exception but a RunStatus.
class NoEquilibrium : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A request to stop (interrupt.hpp) that arrived where there is no increment to end first.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace voussoir::host
