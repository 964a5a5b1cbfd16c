#pragma once
/// The lanes as they are compiled for one instruction set: the only thing of them that the rest of the program sees.
///
/// kernels/CMakeLists.txt compiles kernels/lanes once for each set, and hides everything of the result but its LaneSet.
/// Inline functions of the standard library, of Kokkos and of our own headers, compiled for AVX-512, can therefore not
/// become the copy that the linker keeps for the whole program.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/contact/cell.hpp"
#include "kernels/isa/instruction_set.hpp"
#include "kernels/state/network.hpp"
#include "kernels/state/requests.hpp"
#include "kernels/state/rve_batch.hpp"

namespace voussoir::kernels {

struct LaneSet {
  InstructionSet isa;
  int floats, doubles;  ///< RVEs side by side

  void (*begin)();  ///< to be called once before the others: makes the static objects of the set

  /// Advance some RVEs as `kernels::advance` (advance_rves.hpp) does.
  Work (*advance_given)(RveBatch& batch, std::span<const StrainRequest> requests, const EngineSettings& settings,
                        std::span<RveReport> reports, std::span<const int> rves);
  Work (*advance_servo)(RveBatch& batch, std::span<const ServoRequest> requests, const EngineSettings& settings,
                        std::span<RveReport> reports, std::span<const int> rves);

  /// Writes the candidate contacts of one RVE (lanes/neighbours.hpp).
  void (*find_candidates)(std::span<const double> positions, std::span<const double> radii, const Cell& cell,
                          double skin, std::vector<std::uint32_t>& keys);

  /// Writes the contacts of one RVE for its network (lanes/committed_network.hpp).
  void (*committed_network)(const RveBatch& batch, std::size_t rve, std::vector<NetworkContact>& out);

  [[nodiscard]] int width(Precision precision) const { return precision == Precision::float32 ? floats : doubles; }
};

}  // namespace voussoir::kernels

/// The sets, by the names that hiding leaves visible. `plain` is compiled with the flags of all other code; its
/// instruction set is the one that these flags allow.
extern "C" {
extern const voussoir::kernels::LaneSet voussoir_lanes_plain;
extern const voussoir::kernels::LaneSet voussoir_lanes_v3;
extern const voussoir::kernels::LaneSet voussoir_lanes_v4;
}
