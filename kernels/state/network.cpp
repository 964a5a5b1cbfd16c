#include "kernels/state/network.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace voussoir::kernels {

namespace {

/// Eq. (22): a = 2 |<exp(2 i theta)>| and theta_a half its argument, every contact weighted alike.
void describe_fabric(std::span<const NetworkContact> contacts, Microstructure& out) {
  double cosine = 0, sine = 0;  // sums over twice the angle of the normal
  for (const NetworkContact& c : contacts) {
    cosine += c.normal_x * c.normal_x - c.normal_y * c.normal_y;
    sine += 2.0 * c.normal_x * c.normal_y;
  }
  out.fabric_anisotropy = contacts.empty() ? 0.0
                                           : 2.0 * std::hypot(cosine, sine) / static_cast<double>(contacts.size());
  const double direction = 0.5 * std::atan2(sine, cosine);
  out.fabric_direction = direction <= -0.5 * std::numbers::pi ? 0.5 * std::numbers::pi : direction;
}

/// Eq. (23), (2 N_c - N_1)/(N_p - N_0 - N_1), of the contacts that carry at least `least` [N]. N_p - N_0 - N_1 is the
/// number of grains with at least two such contacts, whether N_p counts all grains or only those that have one.
double mechanical_coordination(std::span<const NetworkContact> contacts, double least, std::vector<int>& contacts_of) {
  std::fill(contacts_of.begin(), contacts_of.end(), 0);
  int total = 0;
  for (const NetworkContact& c : contacts) {
    const int counts = c.normal_force >= least ? 1 : 0;  // no branch, because half of its predictions would be wrong
    total += counts;
    contacts_of[static_cast<std::size_t>(c.i)] += counts;
    contacts_of[static_cast<std::size_t>(c.j)] += counts;
  }
  const auto one = std::count(contacts_of.begin(), contacts_of.end(), 1);
  const auto none = std::count(contacts_of.begin(), contacts_of.end(), 0);
  const auto several = static_cast<std::ptrdiff_t>(contacts_of.size()) - none - one;
  return several > 0 ? static_cast<double>(2 * total - one) / static_cast<double>(several) : 0.0;
}

double mean_force(std::span<const NetworkContact> contacts) {
  double sum = 0;
  for (const NetworkContact& c : contacts) sum += c.normal_force;
  return contacts.empty() ? 0.0 : sum / static_cast<double>(contacts.size());
}

}  // namespace

void describe_network(std::span<const NetworkContact> contacts, int grains, const MicrostructureRequest& wanted,
                      Microstructure& out) {
  out.coordination = 2.0 * static_cast<double>(contacts.size()) / grains;
  if (wanted.fabric) describe_fabric(contacts, out);
  if (!wanted.coordination && !wanted.strong_networks) return;
  std::vector<int> contacts_of(static_cast<std::size_t>(grains));
  if (wanted.coordination) out.mechanical_coordination = mechanical_coordination(contacts, 0.0, contacts_of);
  if (!wanted.strong_networks) return;
  const double mean = mean_force(contacts);
  for (std::size_t k = 0; k < strong_thresholds.size(); ++k) {
    out.strong_coordination[k] = mechanical_coordination(contacts, strong_thresholds[k] * mean, contacts_of);
  }
}

}  // namespace voussoir::kernels
