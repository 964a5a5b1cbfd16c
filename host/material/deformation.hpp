#pragma once
/// Where fem's displacement gradients become the kernels' deformation gradients.

#include "fem/material_batch.hpp"
#include "kernels/contact/kinematics.hpp"

namespace voussoir::host {

/// F of F - I [-].
[[nodiscard]] inline kernels::Mat2 deformation_of(const fem::Gradient& gradient) {
  return {1.0 + gradient(0, 0), gradient(0, 1), gradient(1, 0), 1.0 + gradient(1, 1)};
}

}  // namespace voussoir::host
