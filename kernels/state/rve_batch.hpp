#pragma once
/// All RVEs of a run: their packings, their committed states, and the trial states that the last evaluation left. This
/// file holds data; the functions that advance them are in advance_rves.hpp.
///
/// The layout is (RVE, grain, component), LayoutRight, so that the numbers of one RVE are contiguous for the thread
/// that advances it. The state is in double, whatever precision the lanes compute in, and it is complete: neighbour
/// lists follow from it.

#include <Kokkos_Core.hpp>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "kernels/contact/kinematics.hpp"
#include "kernels/state/packing.hpp"
#include "kernels/state/requests.hpp"
#include "kernels/state/residence.hpp"

namespace voussoir::kernels {

/// States of `n` RVEs of at most `grains` grains.
struct RveStates {
  template <class T>
  using Array = Kokkos::View<T, Kokkos::LayoutRight, Kokkos::HostSpace>;

  Array<double** [2]> position;  ///< [m], wrapped into the cell
  Array<double**> rotation;      ///< absolute [rad]
  Array<double* [4]> cell;       ///< H row-major; columns are the periodic vectors [m]
  Array<int*> contact_count;
  Array<std::uint32_t**> contact_key;  ///< pair_key(i, j), ascending
  Array<double***> contact_history;    ///< (RVE, contact, k), k as in the law's history_names [SI]

  RveStates() = default;
  /// @param history numbers a contact remembers
  RveStates(std::string_view label, std::size_t n, int grains, int history);
  [[nodiscard]] std::size_t history_size() const { return contact_history.extent(2); }
  /// The numbers of all contacts of an RVE, contact by contact; not to be read where a law remembers nothing.
  [[nodiscard]] double* histories_of(std::size_t rve) const {
    return contact_history.data() + rve * contact_history.extent(1) * history_size();
  }
  [[nodiscard]] int contact_capacity() const { return static_cast<int>(contact_key.extent(1)); }
};

/// A pair i < j in one word; ascending keys are ordered by (i, j).
[[nodiscard]] KOKKOS_INLINE_FUNCTION constexpr std::uint32_t pair_key(int i, int j) {
  return (static_cast<std::uint32_t>(i) << 16) | static_cast<std::uint32_t>(j);
}
[[nodiscard]] KOKKOS_INLINE_FUNCTION constexpr int first_of(std::uint32_t key) { return static_cast<int>(key >> 16); }
[[nodiscard]] KOKKOS_INLINE_FUNCTION constexpr int second_of(std::uint32_t key) {
  return static_cast<int>(key & 0xffffU);
}

inline constexpr int max_grains = 65535;  ///< the two indices of a pair fit one word

/// How the evaluation of one RVE ended. The last three make the increment unusable; `open` and `step_limit` are
/// reported. `neighbour_overflow` also stands for a cell too narrow for its largest grains.
enum class RveStatus : int { converged, step_limit, open, neighbour_overflow, overlap_limit, not_finite };

[[nodiscard]] KOKKOS_INLINE_FUNCTION constexpr bool is_failure(RveStatus s) {
  return s >= RveStatus::neighbour_overflow;
}
[[nodiscard]] const char* name_of(RveStatus s);
[[nodiscard]] const char* name_of(TangentKind kind);  ///< as a case file writes it

/// Answer of one RVE.
struct RveReport {
  RveStatus status = RveStatus::converged;
  int steps = 0;  ///< executed, hold included
  int contacts = 0;
  double stress[4] = {};        ///< Love-Weber, xx xy yx yy, tension positive [Pa]
  double tangent[6] = {};       ///< symmetrised, xxxx xxyy xxxy yyyy yyxy xyxy [Pa]
  double tangent_skew[3] = {};  ///< of a loading tangent, (D_ab - D_ba)/2 of xxyy xxxy yyxy [Pa]
  TangentKind tangent_kind = TangentKind::contact;
  int tangent_iterations = 0;   ///< of a static tangent
  bool tangent_capped = false;  ///< the iterations reached their limit, so the tangent is too stiff, but less than eq.
                                ///< (4); of `loading`: the elastic tangent stands here
  double unbalanced = 0;        ///< rms|f| / (max(p, floor) t d) at the last look [-]
  double inertial_number = 0;   ///< of the strain phase, at the final pressure [-]
  double largest_overlap = 0;   ///< overlap / (r_i + r_j) [-]
  double mean_overlap = 0;      ///< the same, mean over the contacts at the end [-]
  double cell_area = 0;         ///< at the end [m^2]

  /// Compression positive [Pa].
  [[nodiscard]] KOKKOS_INLINE_FUNCTION double pressure() const { return -0.5 * (stress[0] + stress[3]); }
};

/// Candidate contacts, kept between evaluations and over commits. They are found with a wider skin than an evaluation
/// needs, and hold until grains may have come nearer by the difference. An evaluation lists those of them that are near
/// in its committed state, so that its list, and with it every bit, follows from that state alone: no file stores them.
struct CandidateCache {
  std::vector<std::vector<std::uint32_t>> keys;
  std::vector<double> skin;      ///< the skin that they were found with [m]; negative: none
  std::vector<double> spent;     ///< most by which two grains have come nearer since then, in the committed state [m]
  std::vector<double> spending;  ///< the same in the trial state [m]; negative: not known
};

struct RveBatch {
  std::vector<Packing> packings;
  std::vector<int> packing_of;  ///< by RVE
  RveStates committed;
  RveStates trial;
  CandidateCache candidates;
  std::shared_ptr<Residence> residence;  ///< where a device advances the RVEs; it then holds the newest states

  [[nodiscard]] std::size_t size() const { return packing_of.size(); }
  [[nodiscard]] const Packing& packing(std::size_t rve) const {
    return packings[static_cast<std::size_t>(packing_of[rve])];
  }
};

/// Copies one RVE's state from one set of states to another of the same shape.
void copy_state(const RveStates& from, RveStates& to, std::size_t rve, std::size_t grains);

/// A batch with room for RVEs of the given packings; the caller fills the states.
/// @param history numbers that a contact of the law remembers
[[nodiscard]] RveBatch make_batch(std::vector<Packing> packings, std::vector<int> packing_of,
                                  int history = history_size<PlainEngineLaw>);

/// Makes the trial states the committed ones; an RVE whose evaluation failed keeps its committed state, and so do the
/// RVEs `kept`.
void commit(RveBatch& batch, std::span<const int> kept = {});

/// Brings the committed states from the device that has newer ones to `batch.committed`. To be called before they are
/// read; without a device it does nothing.
void bring_committed(const RveBatch& batch);
/// The same for one RVE.
void bring_committed(const RveBatch& batch, std::size_t rve);

/// The same beside the next evaluations (Residence::begin_bringing). Invalid without a device.
[[nodiscard]] std::shared_future<void> begin_bringing_committed(const RveBatch& batch);

/// To be called after `committed` was written from outside.
void forget_candidates(RveBatch& batch);

}  // namespace voussoir::kernels
