#pragma once
/// The contact networks of all committed states of a batch.

#include <span>

#include "kernels/state/network.hpp"
#include "kernels/state/rve_batch.hpp"

namespace voussoir::kernels {

/// Mean over the grains of a committed state, counter-clockwise [rad].
[[nodiscard]] double mean_rotation(const RveBatch& batch, std::size_t rve);

/// Describes the contact network of every committed state of a batch, with the normal forces that the contact law
/// gives. `out` has batch.size() entries. kernels/README.md, "Microstructure", has the cost.
void describe_committed(const RveBatch& batch, const MicrostructureRequest& wanted, std::span<Microstructure> out);

}  // namespace voussoir::kernels
