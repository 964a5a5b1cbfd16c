#pragma once
/// How much work a case is, before it is run.

#include "host/case/case.hpp"
#include "host/estimate/case_size.hpp"

namespace voussoir::host {

/// Makes the mesh to count its points. The estimate of particle steps is good to a factor of 2: see work.cpp.
[[nodiscard]] CaseSize case_size(const Case& input);

}  // namespace voussoir::host
