#pragma once
/// Committed states as one array: which of an RVE's two slots is the committed one differs from RVE to RVE.

#include "kernels/device/block_batch.hpp"

namespace voussoir::kernels::device {

/// Copies the committed state of an RVE into slot 0 of `to`. Places for contacts beyond the last one are not copied.
template <class Block>
KOKKOS_FORCEINLINE_FUNCTION void copy_committed_state(const Block& block, const DeviceStates& from,
                                                      const DeviceStates& to, int rve) {
  const DeviceState a = state_of(from, from.committed_slot[rve], rve), b = state_of(to, 0, rve);
  const auto copy = [&](const auto* source, auto* target, int count) {
    for (int k = block.thread(); k < count; k += block.threads()) target[k] = source[k];
  };
  const int contacts = *a.contact_count;
  copy(a.position, b.position, 2 * from.grains);
  copy(a.rotation, b.rotation, from.grains);
  copy(a.cell, b.cell, 4);
  copy(a.contact_count, b.contact_count, 1);
  copy(a.contact_key, b.contact_key, contacts);
  copy(a.contact_history, b.contact_history, contacts * from.history);
}

}  // namespace voussoir::kernels::device
