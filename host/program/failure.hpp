#pragma once
/// What an exception means to the user: an outcome, from which process/exit_code.hpp makes the exit code, and a
/// sentence.

#include <exception>
#include <string>

#include "host/process/exit_code.hpp"

namespace voussoir::host {

struct Failure {
  Outcome outcome = Outcome::machine_failure;
  std::string sentence;
};

[[nodiscard]] Failure failure_of(const std::exception_ptr& exception);

/// From now on an exception that nobody can catch, such as one of a thread of the engine that finds no memory, ends the
/// process with its outcome's exit code and one line, and so does a library that ends the process by itself: OpenMP
/// calls exit(1) where it cannot start its threads.
void end_all_failures_by_the_table();

}  // namespace voussoir::host
