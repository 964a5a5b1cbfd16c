#pragma once
/// The contact network of a committed state: of committed_contacts what a network needs, with the same bits, in a
/// quarter of its time.

#include <cstddef>
#include <vector>

#include "kernels/state/network.hpp"
#include "kernels/state/rve_batch.hpp"

namespace voussoir::kernels {

/// Writes the stored contacts of `rve` to `out`, in their order.
void committed_network(const RveBatch& batch, std::size_t rve, std::vector<NetworkContact>& out);

}  // namespace voussoir::kernels
