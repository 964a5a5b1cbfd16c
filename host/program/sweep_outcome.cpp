#include "host/program/sweep_outcome.hpp"

#include <signal.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstring>

namespace voussoir::host {

RunEnd end_of(int status, bool stopped) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    const bool asked = stopped && (signal == SIGUSR1 || signal == SIGINT || signal == SIGTERM);
    // A run that was asked to stop before it listened is ended by the signal itself.
    if (asked) return {.outcome = Outcome::interrupted, .code = exit_code(Outcome::interrupted)};
    return {.outcome = Outcome::machine_failure, .code = 128 + signal, .signal = signal};
  }
  return end_of_code(WEXITSTATUS(status));
}

RunEnd end_of_code(int code) {
  const auto* const known = std::find_if(exit_table.begin(), exit_table.end(),
                                         [code](const ExitStatus& row) { return row.code == code; });
  if (known != exit_table.end()) return {.outcome = known->outcome, .code = code};
  const bool killed = code > 128 && sigabbrev_np(code - 128) != nullptr;
  return {.outcome = Outcome::machine_failure, .code = code, .signal = killed ? code - 128 : 0};
}

std::string name_of(const RunEnd& end) {
  if (!end.outcome) return "not run";
  if (end.signal == 0) return status_of(*end.outcome).name;
  const char* name = sigabbrev_np(end.signal);
  return std::string("killed by ") + (name != nullptr ? std::string("SIG") + name : std::to_string(end.signal));
}

Outcome outcome_of(std::span<const RunEnd> runs) {
  for (const Outcome outcome :
       {Outcome::interrupted, Outcome::machine_failure, Outcome::wrong_input, Outcome::no_equilibrium}) {
    const bool one = std::any_of(runs.begin(), runs.end(), [outcome](const RunEnd& end) {
      return end.outcome.value_or(Outcome::interrupted) == outcome;
    });
    if (one) return outcome;
  }
  return Outcome::done;
}

}  // namespace voussoir::host
