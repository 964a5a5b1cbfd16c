#pragma once
/// The contacts of a committed state with the forces that the contact law gives them there.

#include <cstddef>
#include <vector>

#include "kernels/state/rve_batch.hpp"

namespace voussoir::kernels {

struct CommittedContact {
  int i, j;
  double branch_x, branch_y;  ///< from i to the nearest image of j [m]
  double normal_x, normal_y;  ///< unit vector along it
  double normal_force;        ///< f_n >= 0 [N]
  double tangential_force;    ///< f_t on i along t = (-n_y, n_x) [N]
  double moment;              ///< on i [N m]

  [[nodiscard]] double force_x() const { return -normal_force * normal_x - tangential_force * normal_y; }  ///< on i [N]
  [[nodiscard]] double force_y() const { return -normal_force * normal_y + tangential_force * normal_x; }  ///< on i [N]
};

/// Writes the stored contacts of `rve` to `out`, in their order.
void committed_contacts(const RveBatch& batch, std::size_t rve, std::vector<CommittedContact>& out);

}  // namespace voussoir::kernels
