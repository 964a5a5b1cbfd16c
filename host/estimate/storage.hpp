#pragma once
/// What a case takes of memory and disk.

#include "host/case/case.hpp"
#include "host/estimate/case_size.hpp"

namespace voussoir::host {

/// Adds memory, result files and checkpoints to a size that knows its points and grains.
void add_storage(CaseSize& size, MaterialKind material, const PackingCase& packing, const OutputCase& output);

}  // namespace voussoir::host
