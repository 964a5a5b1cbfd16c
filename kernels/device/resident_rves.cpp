#include "kernels/device/resident_rves.hpp"

namespace voussoir::kernels::device {

HostStates plain(const RveStates& states) {
  return {.position = states.position.data(),
          .rotation = states.rotation.data(),
          .cell = states.cell.data(),
          .contact_count = states.contact_count.data(),
          .contact_key = states.contact_key.data(),
          .contact_history = states.contact_history.data(),
          .grains = static_cast<int>(states.rotation.extent(1)),
          .contacts = states.contact_capacity(),
          .history = static_cast<int>(states.history_size())};
}

std::size_t bytes_of_rve(const HostStates& states) {
  const auto grains = static_cast<std::size_t>(states.grains), contacts = static_cast<std::size_t>(states.contacts);
  const std::size_t of_contact = sizeof(std::uint32_t) + sizeof(double) * static_cast<std::size_t>(states.history);
  return (3 * grains + 4) * sizeof(double) + sizeof(int) + contacts * of_contact;
}

RveSet plain(const RveBatch& batch) {
  return {.packings = batch.packings, .packing_of = batch.packing_of, .committed = plain(batch.committed)};
}

}  // namespace voussoir::kernels::device
