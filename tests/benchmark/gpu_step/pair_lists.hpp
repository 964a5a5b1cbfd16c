#pragma once
/// The list of pairs of each RVE as `find_lists` writes it and a step reads it.

#include <cstdint>

namespace voussoir::gpu_step {

/// A half list: pairs (i, j) with i < j, ascending by i, then by j. RVE v's pairs begin at v * capacity, its rows at
/// v * (grains + 1). The 16-bit indices limit an RVE to 32767 pairs.
template <class Real>
struct PairLists {
  int capacity;                 ///< of pairs an RVE
  Real *branch_x, *branch_y;    ///< b0 = x_j - x_i when the list was made [m]
  Real* gap;                    ///< g0 = |b0|^2 - (r_i + r_j)^2 then [m^2]
  Real *tangential, *moment;    ///< histories: tangential force [N], rolling moment [N m]
  std::uint32_t* grains;        ///< i << 16 | j
  std::uint16_t* row;           ///< (grains + 1): grain i's pairs with larger j are row[i] .. row[i + 1] - 1
  std::uint16_t* incoming_row;  ///< (grains + 1): likewise into `incoming`
  std::uint16_t* incoming;      ///< indices of grain j's pairs with smaller i, ascending
  int* pair_count;              ///< (rve); more than `capacity`: nothing is listed, and so much room is needed
};

constexpr int most_pairs = 0x7fff;

}  // namespace voussoir::gpu_step
