#include "kernels/state/describe_committed.hpp"

#include <Kokkos_Core.hpp>
#include <algorithm>
#include <atomic>
#include <exception>
#include <vector>

#include "kernels/state/committed_contacts.hpp"

namespace voussoir::kernels {

namespace {

/// Working arrays of one RVE.
struct Scratch {
  std::vector<CommittedContact> contacts;
  std::vector<NetworkContact> network;
};

Microstructure describe(const RveBatch& batch, std::size_t rve, const MicrostructureRequest& wanted, Scratch& scratch) {
  Microstructure out;
  const int grains = batch.packing(rve).size();
  for (int i = 0; i < grains; ++i) out.grain_rotation += batch.committed.rotation(rve, i);
  out.grain_rotation /= grains;
  committed_contacts(batch, rve, scratch.contacts);
  scratch.network.clear();
  for (const CommittedContact& c : scratch.contacts) {
    scratch.network.push_back({c.i, c.j, c.normal_x, c.normal_y, c.normal_force});
  }
  describe_network(scratch.network, grains, wanted, out);
  return out;
}

}  // namespace

void describe_committed(const RveBatch& batch, const MicrostructureRequest& wanted, std::span<Microstructure> out) {
  using Space = Kokkos::DefaultHostExecutionSpace;
  constexpr std::size_t share = 16;  // RVEs that reuse one worker's arrays
  std::exception_ptr failure;
  std::atomic_flag failed;
  Kokkos::parallel_for(
      "voussoir::microstructure::committed",
      Kokkos::RangePolicy<Space, Kokkos::Schedule<Kokkos::Dynamic>>(0, (batch.size() + share - 1) / share),
      [&](std::size_t block) {
        try {
          Scratch scratch;
          const std::size_t last = std::min(batch.size(), (block + 1) * share);
          for (std::size_t k = block * share; k < last; ++k) out[k] = describe(batch, k, wanted, scratch);
        } catch (...) {  // for example where memory runs out
          if (!failed.test_and_set()) failure = std::current_exception();
        }
      });
  Space().fence("voussoir::microstructure::committed");
  if (failure) std::rethrow_exception(failure);
}

}  // namespace voussoir::kernels
