#include "kernels/state/network.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "kernels/state/rve_batch.hpp"

namespace voussoir::kernels {

namespace {

/// Sums over contacts, in their order. They are taken together, because each of them waits for its last addition.
struct Sums {
  double cosine = 0, sine = 0;  ///< of twice the angle of the normal
  double normal_force = 0;      ///< [N]
};

Sums sums_of(std::span<const NetworkContact> contacts) {
  Sums sums;
  for (const NetworkContact& c : contacts) {
    sums.cosine += c.normal_x * c.normal_x - c.normal_y * c.normal_y;
    sums.sine += 2.0 * c.normal_x * c.normal_y;
    sums.normal_force += c.normal_force;
  }
  return sums;
}

/// Eq. (22): a = 2 |<exp(2 i theta)>| and theta_a half its argument, every contact weighted alike.
void describe_fabric(const Sums& sums, std::size_t contacts, Microstructure& out) {
  out.fabric_anisotropy = contacts == 0 ? 0.0
                                        : 2.0 * std::hypot(sums.cosine, sums.sine) / static_cast<double>(contacts);
  const double direction = 0.5 * std::atan2(sums.sine, sums.cosine);
  out.fabric_direction = direction <= -0.5 * std::numbers::pi ? 0.5 * std::numbers::pi : direction;
}

/// Networks whose contacts are counted together: that of all contacts and the strong ones.
constexpr std::size_t networks = 1 + strong_thresholds.size();

/// Contacts of a grain, one number of 16 bits for each network. This is enough, because a grain touches another one
/// once, and there are no more than max_grains.
using Counts = std::uint64_t;
constexpr int count_bits = 16;
static_assert(networks * count_bits <= 64 && max_grains < (1 << count_bits));

/// Eq. (23), (2 N_c - N_1)/(N_p - N_0 - N_1), of the contacts that carry at least `least` [N], for each network.
/// N_p - N_0 - N_1 is the number of grains with at least two such contacts, whether N_p counts all grains or only those
/// that have one.
std::array<double, networks> mechanical_coordination(std::span<const NetworkContact> contacts, int grains,
                                                     const std::array<double, networks>& least) {
  std::vector<Counts> counts_of(static_cast<std::size_t>(grains));
  for (const NetworkContact& c : contacts) {
    Counts counts = 0;  // no branches, because half of their predictions would be wrong
    for (std::size_t k = 0; k < networks; ++k) counts |= Counts{c.normal_force >= least[k]} << (count_bits * k);
    counts_of[static_cast<std::size_t>(c.i)] += counts;
    counts_of[static_cast<std::size_t>(c.j)] += counts;
  }
  std::array<int, networks> twice{}, one{}, several{};  // 2 N_c, N_1 and N_p - N_0 - N_1
  for (const Counts counts : counts_of) {
    for (std::size_t k = 0; k < networks; ++k) {
      const auto n = static_cast<int>((counts >> (count_bits * k)) & ((Counts{1} << count_bits) - 1));
      twice[k] += n;
      one[k] += n == 1 ? 1 : 0;
      several[k] += n > 1 ? 1 : 0;
    }
  }
  std::array<double, networks> out{};
  for (std::size_t k = 0; k < networks; ++k) {
    if (several[k] > 0) out[k] = static_cast<double>(twice[k] - one[k]) / static_cast<double>(several[k]);
  }
  return out;
}

}  // namespace

void describe_network(std::span<const NetworkContact> contacts, int grains, const MicrostructureRequest& wanted,
                      Microstructure& out) {
  out.coordination = 2.0 * static_cast<double>(contacts.size()) / grains;
  const Sums sums = wanted.fabric || wanted.strong_networks ? sums_of(contacts) : Sums{};
  if (wanted.fabric) describe_fabric(sums, contacts.size(), out);
  if (!wanted.coordination && !wanted.strong_networks) return;
  const double mean = contacts.empty() ? 0.0 : sums.normal_force / static_cast<double>(contacts.size());
  std::array<double, networks> least{0.0};
  for (std::size_t k = 1; k < networks; ++k) least[k] = strong_thresholds[k - 1] * mean;
  const auto found = mechanical_coordination(contacts, grains, least);
  if (wanted.coordination) out.mechanical_coordination = found[0];
  if (wanted.strong_networks) std::copy(found.begin() + 1, found.end(), out.strong_coordination.begin());
}

}  // namespace voussoir::kernels
