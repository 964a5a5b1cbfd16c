#include "kernels/describe_committed.hpp"

#include <Kokkos_Core.hpp>
#include <algorithm>
#include <atomic>
#include <exception>
#include <vector>

#include "kernels/isa/choose_lanes.hpp"
#include "kernels/state/network_sums.hpp"

namespace voussoir::kernels {

namespace {

/// [m^2] @param cell xx, xy, yx, yy
double area_of(const double* cell) { return cell[0] * cell[3] - cell[1] * cell[2]; }

/// Sum over the grains of a committed state, counter-clockwise [rad].
double sum_of_rotations(const RveStates& states, std::size_t rve, int grains) {
  double sum = 0;
  for (int i = 0; i < grains; ++i) sum += states.rotation(rve, i);
  return sum;
}

CommittedSummary describe(const RveBatch& batch, std::size_t rve, const MicrostructureRequest& wanted,
                          const LaneSet& lanes, std::vector<NetworkContact>& contacts) {
  CommittedSummary out;
  const int grains = batch.packing(rve).size();
  out.cell_area = area_of(&batch.committed.cell(rve, 0));
  out.network.grain_rotation = sum_of_rotations(batch.committed, rve, grains) / grains;
  if (wanted.any()) {
    lanes.committed_network(batch, rve, contacts);
    describe_network(contacts, grains, wanted, out.network);
  } else {
    describe_network({batch.committed.contact_count(rve), {}, {}}, grains, wanted, out.network);
  }
  return out;
}

void describe_on_host(const RveBatch& batch, const MicrostructureRequest& wanted, std::span<CommittedSummary> out) {
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

/// The device sums up in the order of the host, so that both have the same bits.
void describe_on_device(const RveBatch& batch, const MicrostructureRequest& wanted, std::span<CommittedSummary> out) {
  std::vector<CommittedSums> sums(batch.size());
  batch.residence->describe(wanted, sums);
  for (std::size_t k = 0; k < sums.size(); ++k) {
    const int grains = batch.packing(k).size();
    out[k] = {.cell_area = area_of(sums[k].cell), .network = {.grain_rotation = sums[k].rotation / grains}};
    describe_network(sums[k].network, grains, wanted, out[k].network);
  }
}

}  // namespace

void describe_committed(const RveBatch& batch, const MicrostructureRequest& wanted, std::span<CommittedSummary> out) {
  if (batch.residence && batch.residence->has_committed()) return describe_on_device(batch, wanted, out);
  bring_committed(batch);  // they may still be on their way
  describe_on_host(batch, wanted, out);
}

}  // namespace voussoir::kernels
