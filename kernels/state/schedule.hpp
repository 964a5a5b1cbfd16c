#pragma once
/// What decides how RVEs are run: how much work they ask for, and which parts of the law they need.

#include "kernels/state/requests.hpp"
#include "kernels/state/rve_batch.hpp"

namespace voussoir::kernels {

[[nodiscard]] inline int predicted_steps(const StrainRequest& r) { return r.strain_steps + r.hold_cap / 4; }
[[nodiscard]] inline int predicted_steps(const ServoRequest& r) { return r.max_steps; }

/// Whether any grain resists rolling; where none does, that part of the law is compiled out.
[[nodiscard]] bool rolls(const RveBatch& batch);

}  // namespace voussoir::kernels
