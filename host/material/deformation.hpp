#pragma once
/// The conversion of fem's displacement gradients to the kernels' deformation gradients.

#include "fem/material_batch.hpp"
#include "kernels/contact/kinematics.hpp"

namespace voussoir::host {

/// The deformation gradient F of a displacement gradient F - I [-].
[[nodiscard]] inline kernels::Mat2 deformation_of(const fem::Gradient& gradient) {
  return {1.0 + gradient(0, 0), gradient(0, 1), gradient(1, 0), 1.0 + gradient(1, 1)};
}

}  // namespace voussoir::host
