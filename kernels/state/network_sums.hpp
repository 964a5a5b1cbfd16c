#pragma once
/// Sums over the contacts and grains of one committed state, from which the measures of its network follow
/// (state/network.hpp), and what one contact or one grain adds to them. The host and the blocks of a device share these
/// functions, and the host alone makes measures of the sums.

#include <cstdint>

#include "kernels/contact/kinematics.hpp"
#include "kernels/state/network.hpp"

namespace voussoir::kernels {

/// Networks whose contacts are counted together: that of all contacts and the strong ones.
inline constexpr int networks = 1 + static_cast<int>(strong_thresholds.size());

/// Sums over contacts, in their order.
struct ContactSums {
  double cosine = 0, sine = 0;  ///< of twice the angle of the normal
  double normal_force = 0;      ///< [N]

  KOKKOS_FORCEINLINE_FUNCTION ContactSums& operator+=(const ContactSums& other) {
    cosine += other.cosine;
    sine += other.sine;
    normal_force += other.normal_force;
    return *this;
  }
};

/// What one contact adds. @param normal_x, normal_y unit vector
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION ContactSums sums_of_contact(double normal_x, double normal_y,
                                                                      double normal_force) {
  return {normal_x * normal_x - normal_y * normal_y, 2.0 * normal_x * normal_y, normal_force};
}

/// Least normal force of each network's contacts [N].
struct LeastForces {
  double of[networks];
};

/// The thresholds as numbers that a device is given. @param of_mean of each network, over the mean normal force
struct NetworkThresholds {
  double of_mean[networks];

  /// @param normal_force sum over the contacts [N]
  [[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION LeastForces least(double normal_force, int contacts) const {
    const double mean = contacts == 0 ? 0.0 : normal_force / static_cast<double>(contacts);
    LeastForces out{};
    for (int k = 1; k < networks; ++k) out.of[k] = of_mean[k] * mean;
    return out;
  }
};
[[nodiscard]] inline NetworkThresholds network_thresholds() {
  NetworkThresholds out{};
  for (int k = 1; k < networks; ++k) out.of_mean[k] = strong_thresholds[static_cast<std::size_t>(k - 1)];
  return out;
}

/// Contacts of a grain, one number of 16 bits for each network. This is enough, because a grain touches another one
/// once, and there are no more than max_grains.
using ContactCounts = std::uint64_t;
inline constexpr int count_bits = 16;
static_assert(networks * count_bits <= 64);

/// What a contact adds to the counts of both its grains.
[[nodiscard]] KOKKOS_FORCEINLINE_FUNCTION ContactCounts counts_of_contact(double normal_force,
                                                                          const LeastForces& least) {
  ContactCounts counts = 0;  // no branches, because half of their predictions would be wrong
  for (int k = 0; k < networks; ++k) counts |= ContactCounts{normal_force >= least.of[k]} << (count_bits * k);
  return counts;
}

/// Counts over the grains, for each network.
struct GrainTally {
  int twice[networks];    ///< 2 N_c
  int one[networks];      ///< N_1, grains with one contact
  int several[networks];  ///< N_p - N_0 - N_1, grains with at least two

  KOKKOS_FORCEINLINE_FUNCTION void add(ContactCounts counts_of_grain) {
    for (int k = 0; k < networks; ++k) {
      const auto n = static_cast<int>((counts_of_grain >> (count_bits * k)) & ((ContactCounts{1} << count_bits) - 1));
      twice[k] += n;
      one[k] += n == 1 ? 1 : 0;
      several[k] += n > 1 ? 1 : 0;
    }
  }
};

struct NetworkSums {
  int contacts;
  ContactSums of_contacts;  ///< where fabric or strong networks are wanted
  GrainTally tally;         ///< where a coordination is wanted
};

/// What a device answers of one committed state: plain numbers, which cross the border of its library.
struct CommittedSums {
  double cell[4];   ///< [m]
  double rotation;  ///< sum over the grains, in their order [rad]
  NetworkSums network;
};

[[nodiscard]] inline bool needs_contact_sums(const MicrostructureRequest& wanted) {
  return wanted.fabric || wanted.strong_networks;
}
[[nodiscard]] inline bool needs_tally(const MicrostructureRequest& wanted) {
  return wanted.coordination || wanted.strong_networks;
}

/// Writes to `out` the coordination, and those quantities of `wanted` that follow from the contacts.
void describe_network(const NetworkSums& sums, int grains, const MicrostructureRequest& wanted, Microstructure& out);

}  // namespace voussoir::kernels
