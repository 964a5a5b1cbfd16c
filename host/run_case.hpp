#pragma once
/// From a case to its results: the choice by kind, and the answer to whoever waits.

#include "host/case.hpp"
#include "host/run_folder.hpp"

namespace voussoir::host {

/// Runs the case in options.folder (already checked by check_folder) and returns an exit code of exit_code.hpp. Needs an
/// initialised Kokkos. Throws io::InputError on input that shows itself to be wrong only here.
[[nodiscard]] int run_case(const Case& input, const RunOptions& options);

/// Numbers of a case before it is run.
struct CaseSize {
  std::size_t points = 0;         ///< Gauss points of the largest mesh
  std::size_t column_points = 0;  ///< of the column
  std::size_t increments = 0;     ///< planned, all stages
  double grains = 0;              ///< of all RVEs of the largest mesh; 0 without grains
  double particle_steps = 0;      ///< estimate of the whole run [grains x steps]; 0 without grains
};
[[nodiscard]] CaseSize case_size(const Case& input);

}  // namespace voussoir::host
