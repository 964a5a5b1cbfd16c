#pragma once
/// An estimate of the work of a case, before it is run.

#include "host/case/case.hpp"
#include "host/estimate/case_size.hpp"

namespace voussoir::host {

/// The size of a case; the mesh is made to count its points. Particle-steps are good to a factor of 2 (work.cpp).
[[nodiscard]] CaseSize case_size(const Case& input);

}  // namespace voussoir::host
