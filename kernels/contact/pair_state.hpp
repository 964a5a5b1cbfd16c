#pragma once
/// The working state of one group: W RVEs cloned from one packing, one per lane. The values of a number in all lanes
/// stand side by side.
///
/// The layout is (grain, quantity, lane) and (pair, quantity, lane), so that all numbers of one grain or pair are a run
/// of whole cache lines. One thread owns a group for a whole evaluation, so that the group stays in its caches (L1 and
/// L2).

#include <cstdint>
#include <vector>

#include "kernels/contact/contact_law.hpp"
#include "kernels/contact/kinematics.hpp"

namespace voussoir::kernels {

/// The motion of a grain, relative to the affine field and since the lane's last rebase; velocities are per step.
template <class V>
struct GrainLanes {
  V u_x, u_y;                  ///< displacement [m]
  V w_x, w_y;                  ///< velocity [m/step]
  V spin;                      ///< [rad/step]
  V force_x, force_y, torque;  ///< partial sums while a step runs, zero between steps [N], [N m]
  V rotation;                  ///< since the last commit [rad]
};

/// Constants of a grain, the same in all lanes.
template <class real>
struct GrainShape {
  real radius;                                   ///< [m]
  real mobility;                                 ///< dt^2/m [m/N]
  real rotational_mobility;                      ///< dt^2/J [rad/(N m)]
  real half_mobility, half_rotational_mobility;  ///< half of each
};

/// The numbers of a candidate contact that differ from lane to lane.
template <class Law>
struct PairLanes {
  using V = typename Law::Value;
  V branch_x, branch_y;  ///< b0 at the lane's last rebase [m]; 0 where the lane does not list the pair
  V gap;                 ///< g0 = |b0|^2 - R^2 [m^2]; R^2 where the lane does not list the pair: never in contact
  typename Law::History history;
};

/// The numbers of a candidate contact that are the same in all lanes. The contact stands in the row of grain i; `other`
/// is j > i.
template <class Law>
struct PairShape {
  using real = real_of<typename Law::Value>;
  std::int32_t other;
  std::int32_t other_bytes;        ///< where `other` stands among a group's grains
  std::int32_t active;             ///< 1 while any lane may hold history; a pair is skipped only when no lane touches
                                   ///< and this is 0
  real inverse_sum;                ///< 1/R [1/m]
  real minus_inverse_sum_squared;  ///< -1/R^2 [1/m^2]
  real minus_half_sum;             ///< -R/2 [m]
  real radius_other;               ///< [m]
  typename Law::Pair law;          ///< the law's own constants
};

/// Rigid and affine motion of the cells, rounded from double once a step.
template <class V>
struct CellMotion {
  V f_xx, f_xy, f_yx, f_yy;  ///< F - I since the lane's last rebase
  V d_xy, d_difference;      ///< D_xy and D_yy - D_xx of the motion that led to the current positions, D = sym L
  V e_xx, e_xy, e_yx, e_yy;  ///< E of the coming motion
  V rotation;                ///< W of the coming motion
  V alive;                   ///< 1, or 0 for a lane that is finished, empty or lost
};

/// The purpose of a sweep over all pairs.
enum class Sweep {
  advance,  ///< it advances the grains
  measure,  ///< it also sums stress and unbalanced force
};

/// Sums over one sweep, lane by lane.
template <class V>
struct SweepSums {
  V stress_xx = V(0), stress_xy = V(0), stress_yx = V(0), stress_yy = V(0);  ///< sum P_i b_j [N m]
  V force_squared = V(0);                                                    ///< sum |f|^2 over grains [N^2]
  V largest_measure = V(0);                                                  ///< largest e = -g/R^2 over contacts [-]
};

inline constexpr int pairs_ahead = 2;  ///< a sweep fetches the grain of the pair that is this many places ahead in the
                                       ///< list

/// The arrays are vectors, not views, because a group grows them inside the parallel region, where no view may be made.
template <class Law>
struct GroupState {
  using V = typename Law::Value;
  int n_grains = 0;
  double local_damping = 0.3;
  std::vector<GrainLanes<V>> grains;
  std::vector<GrainShape<real_of<V>>> shapes;
  std::vector<int> row;                     ///< pairs of grain i: row[i] .. row[i + 1]
  std::vector<PairLanes<Law>> pairs;        ///< the first row.back() are in use
  std::vector<PairShape<Law>> pair_shapes;  ///< `pairs_ahead` more follow those in use, of grain 0
  CellMotion<V> motion;
};

}  // namespace voussoir::kernels
