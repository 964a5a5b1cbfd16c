#pragma once
/// The contact network of a committed state: what a network needs of kernels::committed_contacts
/// (state/committed_contacts.hpp), with the same bits in a fifth of its time.

#include <cstddef>
#include <vector>

#include "kernels/state/network.hpp"
#include "kernels/state/rve_batch.hpp"

namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES {

/// Writes the stored contacts of `rve` to `out`, in their order.
void committed_network(const RveBatch& batch, std::size_t rve, std::vector<NetworkContact>& out);

}  // namespace voussoir::kernels::lanes::inline VOUSSOIR_LANES
