#include "kernels/state/network.hpp"

#include <Kokkos_Core.hpp>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <numbers>

#include "kernels/state/committed_contacts.hpp"

namespace voussoir::kernels {

namespace {

/// Eq. (22): a = 2 |<exp(2 i theta)>| and theta_a half its argument, every contact weighted alike.
void describe_fabric(std::span<const NetworkContact> contacts, Microstructure& out) {
  double cosine = 0, sine = 0;  // of twice the angle of the normal
  for (const NetworkContact& c : contacts) {
    cosine += c.normal_x * c.normal_x - c.normal_y * c.normal_y;
    sine += 2.0 * c.normal_x * c.normal_y;
  }
  out.fabric_anisotropy = contacts.empty() ? 0.0
                                           : 2.0 * std::hypot(cosine, sine) / static_cast<double>(contacts.size());
  const double direction = 0.5 * std::atan2(sine, cosine);
  out.fabric_direction = direction <= -0.5 * std::numbers::pi ? 0.5 * std::numbers::pi : direction;
}

/// Eq. (23), (2 N_c - N_1)/(N_p - N_0 - N_1), of the contacts that carry at least `least` [N]: N_p - N_0 - N_1 are the
/// grains with two of them or more, whether N_p counts all grains or those involved.
double mechanical_coordination(std::span<const NetworkContact> contacts, double least, std::vector<int>& contacts_of) {
  std::fill(contacts_of.begin(), contacts_of.end(), 0);
  int total = 0;
  for (const NetworkContact& c : contacts) {
    if (!(c.normal_force >= least)) continue;
    ++total;
    ++contacts_of[static_cast<std::size_t>(c.i)];
    ++contacts_of[static_cast<std::size_t>(c.j)];
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

/// Working arrays of one RVE.
struct Scratch {
  std::vector<CommittedContact> contacts;
  std::vector<NetworkContact> network;
};

Microstructure describe(const RveBatch& batch, std::size_t rve, const MicrostructureRequest& wanted, Scratch& scratch) {
  Microstructure out;
  const int grains = batch.packing(rve).size();
  for (int i = 0; i < grains; ++i) out.grain_rotation += batch.committed.rotation(rve, i);
  out.grain_rotation /= grains;
  committed_contacts(batch, rve, scratch.contacts);
  scratch.network.clear();
  for (const CommittedContact& c : scratch.contacts) {
    scratch.network.push_back({c.i, c.j, c.normal_x, c.normal_y, c.normal_force});
  }
  describe_network(scratch.network, grains, wanted, out);
  return out;
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

void describe_committed(const RveBatch& batch, const MicrostructureRequest& wanted, std::span<Microstructure> out) {
  using Space = Kokkos::DefaultHostExecutionSpace;
  constexpr std::size_t share = 16;  // RVEs that reuse one worker's arrays
  std::exception_ptr failure;
  std::atomic_flag failed;
  Kokkos::parallel_for(
      "voussoir::microstructure::committed",
      Kokkos::RangePolicy<Space, Kokkos::Schedule<Kokkos::Dynamic>>(0, (batch.size() + share - 1) / share),
      [&](std::size_t block) {
        try {
          Scratch scratch;
          const std::size_t last = std::min(batch.size(), (block + 1) * share);
          for (std::size_t k = block * share; k < last; ++k) out[k] = describe(batch, k, wanted, scratch);
        } catch (...) {  // no memory, say
          if (!failed.test_and_set()) failure = std::current_exception();
        }
      });
  Space().fence("voussoir::microstructure::committed");
  if (failure) std::rethrow_exception(failure);
}

}  // namespace voussoir::kernels
