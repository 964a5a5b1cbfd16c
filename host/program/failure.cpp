#include "host/program/failure.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "host/case/failure.hpp"

namespace voussoir::host {
namespace {

[[noreturn]] void end_by_exception() {
  const Failure failure = failure_of(std::current_exception());
  std::fprintf(stderr, "voussoir: %s\n", failure.sentence.c_str());
  std::fflush(stdout);
  _exit(exit_code(failure.outcome));
}

void correct_exit_code(int code, void* /*unused*/) {
  const bool known = std::any_of(exit_table.begin(), exit_table.end(),
                                 [code](const ExitStatus& status) { return status.code == code; });
  if (known) return;
  std::fflush(nullptr);
  _exit(exit_code(Outcome::machine_failure));
}

}  // namespace

void end_all_failures_by_the_table() {
  std::set_terminate(end_by_exception);
  on_exit(correct_exit_code, nullptr);
}

}  // namespace voussoir::host
