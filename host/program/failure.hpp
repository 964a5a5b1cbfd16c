#pragma once
/// The end of the process by an exception that nobody has caught. host/case/failure.hpp says what exceptions mean.

namespace voussoir::host {

/// From now on an exception that nobody can catch, such as one of a thread of the engine that finds no memory, ends the
/// process with its outcome's exit code and one line, and so does a library that ends the process by itself: OpenMP
/// calls exit(1) where it cannot start its threads.
void end_all_failures_by_the_table();

}  // namespace voussoir::host
