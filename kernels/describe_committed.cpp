#include "kernels/describe_committed.hpp"

#include <Kokkos_Core.hpp>
#include <algorithm>
#include <atomic>
#include <exception>
#include <vector>

#include "kernels/isa/choose_lanes.hpp"

namespace voussoir::kernels {

namespace {

Microstructure describe(const RveBatch& batch, std::size_t rve, const MicrostructureRequest& wanted,
                        const LaneSet& lanes, std::vector<NetworkContact>& contacts) {
  Microstructure out;
  out.grain_rotation = mean_rotation(batch, rve);
  lanes.committed_network(batch, rve, contacts);
  describe_network(contacts, batch.packing(rve).size(), wanted, out);
  return out;
}

}  // namespace

double mean_rotation(const RveBatch& batch, std::size_t rve) {
  const int grains = batch.packing(rve).size();
  double sum = 0;
  for (int i = 0; i < grains; ++i) sum += batch.committed.rotation(rve, i);
  return sum / grains;
}

void describe_committed(const RveBatch& batch, const MicrostructureRequest& wanted, std::span<Microstructure> out) {
  using Space = Kokkos::DefaultHostExecutionSpace;
  constexpr std::size_t share = 16;  // RVEs that reuse one worker's array
  const LaneSet& lanes = *chosen_lanes().lanes;
  std::exception_ptr failure;
  std::atomic_flag failed;
  Kokkos::parallel_for(
      "voussoir::microstructure::committed",
      Kokkos::RangePolicy<Space, Kokkos::Schedule<Kokkos::Dynamic>>(0, (batch.size() + share - 1) / share),
      [&](std::size_t block) {
        try {
          std::vector<NetworkContact> contacts;
          const std::size_t last = std::min(batch.size(), (block + 1) * share);
          for (std::size_t k = block * share; k < last; ++k) out[k] = describe(batch, k, wanted, lanes, contacts);
        } catch (...) {  // for example where memory runs out
          if (!failed.test_and_set()) failure = std::current_exception();
        }
      });
  Space().fence("voussoir::microstructure::committed");
  if (failure) std::rethrow_exception(failure);
}

}  // namespace voussoir::kernels
