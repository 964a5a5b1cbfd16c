#pragma once
/// An estimate of the memory and the disk space that a case takes.

#include "host/case/case.hpp"
#include "host/estimate/case_size.hpp"

namespace voussoir::host {

/// Sets memory, result files and checkpoints of a size whose points, grains and tests are known.
void add_storage(CaseSize& size, const Case& input);

/// The least memory that a mesh of so many Gauss points takes, without its grains [bytes].
[[nodiscard]] double mesh_memory(double points);

/// Adds the memory of the curves of biaxial tests.
void add_curves(CaseSize& size, const BiaxialCase& test);

}  // namespace voussoir::host
