#pragma once
/// The contact networks of all committed states of a batch.

#include <span>

#include "kernels/state/network.hpp"
#include "kernels/state/rve_batch.hpp"

namespace voussoir::kernels {

/// Committed states of a batch, RVEs side by side; normal forces are the contact law's. `out` has batch.size() entries.
/// Cost: README.md, "Microstructure".
void describe_committed(const RveBatch& batch, const MicrostructureRequest& wanted, std::span<Microstructure> out);

}  // namespace voussoir::kernels
