#pragma once
/// What an exception means to the user: an outcome, from which process/exit_code.hpp makes the exit code, and a
/// sentence. The program and the C interface of the library use the same table.

#include <exception>
#include <string>

#include "host/process/exit_code.hpp"

namespace voussoir::host {

struct Failure {
  Outcome outcome = Outcome::machine_failure;
  std::string sentence;
};

[[nodiscard]] Failure failure_of(const std::exception_ptr& exception);

}  // namespace voussoir::host
