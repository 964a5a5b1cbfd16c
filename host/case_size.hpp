#pragma once
/// How large a case is, and what it will cost, before it is run.

#include <cstddef>

#include "host/case.hpp"

namespace voussoir::host {

struct CaseSize {
  std::size_t points = 0;         ///< Gauss points of the largest mesh
  std::size_t column_points = 0;  ///< of the column
  std::size_t increments = 0;     ///< planned, all stages
  std::size_t tests = 0;          ///< of a calibration
  double grains = 0;              ///< of all RVEs of the largest mesh; 0 without grains
  double particle_steps = 0;      ///< estimate of the whole run [grains x steps], packings apart; 0 without grains
};

/// Makes the mesh to count its points. The estimate of particle steps is good to a factor of 2: see case_size.cpp.
[[nodiscard]] CaseSize case_size(const Case& input);

}  // namespace voussoir::host
