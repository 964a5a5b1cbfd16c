#pragma once
/// The data on a device that blocks read and write, as plain pointers: packings, the two states of each RVE, candidates
/// and the requests of one call. The owner is ResidentRves (resident_rves.hpp).

#include <cstdint>

#include "kernels/contact/contact_law.hpp"
#include "kernels/contact/pair_state.hpp"
#include "kernels/course/run_scales.hpp"
#include "kernels/state/requests.hpp"

namespace voussoir::kernels::device {

/// The packings, by (packing, grain); `stride` is the number of grains of the largest.
template <class real>
struct DevicePackings {
  const RunScales* scales;  ///< by packing
  const double* radii;      ///< [m]
  const GrainShape<real>* shapes;
  const std::uint8_t* class_of;            ///< nullptr where every packing has one class
  const GrainMaterialOf<real>* materials;  ///< (packing, class)
  int stride, class_stride;
};

/// The numbers of the packings from which contact networks follow, as the host has them.
struct ExactPackings {
  const int* grains;               ///< by packing
  const double* radii;             ///< [m]
  const std::uint8_t* class_of;    ///< nullptr where every packing has one class
  const GrainMaterial* materials;  ///< (packing, class)
  int stride, class_stride;
};

/// The states of all RVEs, twice: `committed_slot` says which of the two is the committed one, the other one is the
/// trial state. Arrays are by (slot, RVE, ...).
struct DeviceStates {
  double* position;  ///< (grain, 2) [m], wrapped into the cell
  double* rotation;  ///< by grain [rad]
  double* cell;      ///< (4) [m]
  int* contact_count;
  std::uint32_t* contact_key;           ///< by contact, ascending
  double* contact_history;              ///< (contact, k)
  std::uint8_t* committed_slot;         ///< by RVE
  std::uint8_t* evaluated;              ///< by RVE: whether there is a trial state that may be committed
  int rves, grains, contacts, history;  ///< extents of the arrays

  /// Where the numbers of a state stand among those of all states.
  [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION std::size_t place(int slot, int rve) const {
    return static_cast<std::size_t>(slot) * static_cast<std::size_t>(rves) + static_cast<std::size_t>(rve);
  }
};

/// One state.
struct DeviceState {
  double *position, *rotation, *cell;
  int* contact_count;
  std::uint32_t* contact_key;
  double* contact_history;
};

[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION DeviceState state_of(const DeviceStates& all, int slot, int rve) {
  const std::size_t k = all.place(slot, rve);
  const auto grains = static_cast<std::size_t>(all.grains), contacts = static_cast<std::size_t>(all.contacts);
  return {all.position + 2 * grains * k,
          all.rotation + grains * k,
          all.cell + 4 * k,
          all.contact_count + k,
          all.contact_key + contacts * k,
          all.contact_history + static_cast<std::size_t>(all.history) * contacts * k};
}

/// Candidates of each RVE, as CandidateCache keeps them for the lanes.
struct DeviceCandidates {
  std::uint32_t* key;  ///< (RVE, candidate), ascending
  int* count;          ///< by RVE
  double* skin;        ///< that they were found with [m]; negative: none
  double* spent;       ///< most by which two grains have come nearer since, in the committed state [m]
  double* spending;    ///< the same in the trial state [m]; negative: not known
  int capacity;        ///< of an RVE
  bool of_blocks;      ///< the arrays are by block and not by RVE: candidates of this launch alone
};

/// What one call works on. `order` has the RVEs of the call, most work first; block k advances order[k].
template <class real, class Drive>
struct BlockBatch {
  DevicePackings<real> packings;
  DeviceStates states;
  DeviceCandidates candidates;
  const int* packing_of;  ///< by RVE
  const int* order;
  const Drive* drives;   ///< by block
  RveReport* reports;    ///< by block
  ServoSample* samples;  ///< (RVE, sample), of stress-controlled cells
  int* sample_count;     ///< by RVE
  int sample_room;
  std::uint8_t* overflown;  ///< by RVE: its list has more pairs than the block has room for
};

}  // namespace voussoir::kernels::device
