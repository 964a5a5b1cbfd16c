#include "tests/device_blocks.hpp"

#include "kernels/device/resident_batch.hpp"
#include "tests/device_threads.hpp"

namespace voussoir::kernels {

std::unique_ptr<device::ResidentRves> hold(const device::RveSet& rves, Precision precision, const Blocks& blocks) {
  using InMemory = device::ThreadBackend<device::InMemory>;
  using InRegisters = device::ThreadBackend<device::BlockPlan<160, 50>>;
  InMemory::threads = InRegisters::threads = blocks.threads;
  InMemory::first_pairs = blocks.first_pairs;
  switch (blocks.kind) {
    case BlockKind::in_memory:
      return device::hold<InMemory>(rves, precision);
    case BlockKind::in_registers:
      return device::hold<InRegisters>(rves, precision);
    case BlockKind::serial:
      break;
  }
  return device::hold<device::HostBackend>(rves, precision);
}

}  // namespace voussoir::kernels
