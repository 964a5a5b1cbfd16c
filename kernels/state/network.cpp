#include "kernels/state/network.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include "kernels/state/network_sums.hpp"
#include "kernels/state/rve_batch.hpp"

namespace voussoir::kernels {

static_assert(max_grains < (1 << count_bits));

namespace {

/// The sums are taken together, because each of them waits for its last addition.
ContactSums sums_of(std::span<const NetworkContact> contacts) {
  ContactSums sums;
  for (const NetworkContact& c : contacts) sums += sums_of_contact(c.normal_x, c.normal_y, c.normal_force);
  return sums;
}

GrainTally tally_of(std::span<const NetworkContact> contacts, int grains, const LeastForces& least) {
  std::vector<ContactCounts> counts_of(static_cast<std::size_t>(grains));
  for (const NetworkContact& c : contacts) {
    const ContactCounts counts = counts_of_contact(c.normal_force, least);
    counts_of[static_cast<std::size_t>(c.i)] += counts;
    counts_of[static_cast<std::size_t>(c.j)] += counts;
  }
  GrainTally tally{};
  for (const ContactCounts counts : counts_of) tally.add(counts);
  return tally;
}

/// Eq. (22): a = 2 |<exp(2 i theta)>| and theta_a half its argument, every contact weighted alike.
void describe_fabric(const ContactSums& sums, int contacts, Microstructure& out) {
  out.fabric_anisotropy = contacts == 0 ? 0.0
                                        : 2.0 * std::hypot(sums.cosine, sums.sine) / static_cast<double>(contacts);
  const double direction = 0.5 * std::atan2(sums.sine, sums.cosine);
  out.fabric_direction = direction <= -0.5 * std::numbers::pi ? 0.5 * std::numbers::pi : direction;
}

/// Eq. (23), (2 N_c - N_1)/(N_p - N_0 - N_1), of one network. N_p - N_0 - N_1 is the number of grains with at least two
/// of its contacts, whether N_p counts all grains or only those that have one.
double mechanical_coordination(const GrainTally& tally, int network) {
  const int several = tally.several[network];
  return several == 0 ? 0.0
                      : static_cast<double>(tally.twice[network] - tally.one[network]) / static_cast<double>(several);
}

}  // namespace

void describe_network(const NetworkSums& sums, int grains, const MicrostructureRequest& wanted, Microstructure& out) {
  out.coordination = 2.0 * static_cast<double>(sums.contacts) / grains;
  if (wanted.fabric) describe_fabric(sums.of_contacts, sums.contacts, out);
  if (wanted.coordination) out.mechanical_coordination = mechanical_coordination(sums.tally, 0);
  if (!wanted.strong_networks) return;
  for (std::size_t k = 0; k < strong_thresholds.size(); ++k)
    out.strong_coordination[k] = mechanical_coordination(sums.tally, 1 + static_cast<int>(k));
}

void describe_network(std::span<const NetworkContact> contacts, int grains, const MicrostructureRequest& wanted,
                      Microstructure& out) {
  NetworkSums sums{static_cast<int>(contacts.size()), {}, {}};
  if (needs_contact_sums(wanted)) sums.of_contacts = sums_of(contacts);
  if (needs_tally(wanted)) {
    const LeastForces least = network_thresholds().least(sums.of_contacts.normal_force, sums.contacts);
    sums.tally = tally_of(contacts, grains, least);
  }
  describe_network(sums, grains, wanted, out);
}

}  // namespace voussoir::kernels
