#pragma once
/// The RVEs that a device holds, whatever the device is. @tparam Backend has the device's memory and its launches
/// (host_backend.hpp says what it must have)

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <vector>

#include "kernels/course/choose_instance.hpp"
#include "kernels/device/block_network.hpp"
#include "kernels/device/block_run.hpp"
#include "kernels/device/held_arrays.hpp"

namespace voussoir::kernels::device {

/// Requests, answers and scratch of one call on the device.
template <class Drive, class Backend>
struct CallArrays {
  DeviceArray<int, Backend> order;
  DeviceArray<Drive, Backend> drives;
  DeviceArray<RveReport, Backend> reports;
  DeviceArray<ServoSample, Backend> samples;
  DeviceArray<int, Backend> sample_count;
  int sample_room = 0;
};

/// Candidates on the device, of RVEs or of the blocks of one launch.
template <class Backend>
struct CandidateArrays {
  DeviceArray<std::uint32_t, Backend> key;
  DeviceArray<int, Backend> count;
  DeviceArray<double, Backend> skin, spent, spending;
  int capacity = 0;

  /// Makes room. Returns whether what was there is lost.
  bool grow(std::size_t owners, int pairs) {
    const int wanted = candidates_per_pair * pairs;
    if (wanted <= capacity && owners <= count.size()) return false;
    capacity = 0;  // in case that there is no memory
    key = DeviceArray<std::uint32_t, Backend>();
    key = DeviceArray<std::uint32_t, Backend>(owners * static_cast<std::size_t>(wanted));
    count.at_least(owners);
    skin.at_least(owners);
    spent.at_least(owners);
    spending.at_least(owners);
    capacity = wanted;
    return true;
  }
  [[nodiscard]] DeviceCandidates view(bool of_blocks) const {
    return {key.data(), count.data(), skin.data(), spent.data(), spending.data(), capacity, of_blocks};
  }
};

/// Makes room for the traces that requests ask for.
template <class Arrays>
void make_sample_room(Arrays& to, std::span<const ServoRequest> requests) {
  to.sample_room = 0;
  for (const ServoRequest& r : requests) {
    if (r.microstructure.any()) throw std::invalid_argument("a device records no microstructure along a path");
    if (r.trace != nullptr) to.sample_room = std::max(to.sample_room, (r.max_steps - 1) / r.trace_interval + 1);
  }
  to.samples.at_least(requests.size() * static_cast<std::size_t>(to.sample_room));
  to.sample_count.at_least(requests.size());
  to.sample_count.write(std::vector<int>(requests.size(), 0));
}
template <class Arrays>
void make_sample_room(Arrays&, std::span<const StrainRequest>) {}

template <class Arrays>
std::size_t append_samples(const Arrays& from, std::span<const ServoRequest> requests) {
  if (from.sample_room == 0) return 0;
  std::vector<int> counts(requests.size());
  std::size_t bytes = from.sample_count.read(counts);
  std::vector<ServoSample> samples;
  for (std::size_t k = 0; k < requests.size(); ++k) {
    samples.resize(static_cast<std::size_t>(counts[k]));
    bytes += from.samples.read(samples, k * static_cast<std::size_t>(from.sample_room));
    if (requests[k].trace != nullptr)
      requests[k].trace->insert(requests[k].trace->end(), samples.begin(), samples.end());
  }
  return bytes;
}
template <class Arrays>
std::size_t append_samples(const Arrays&, std::span<const StrainRequest>) {
  return 0;
}

template <class Law, class Backend>
class ResidentBatch final : public ResidentRves {
 public:
  using real = real_of<typename Law::Value>;

  explicit ResidentBatch(const RveSet& rves)
      : all_packings_(rves.packings),
        packing_of_rve_(rves.packing_of),
        packings_(all_packings_),
        states_(static_cast<int>(size()), packings_.grains(), rves.committed.contacts, rves.committed.history),
        packing_of_(size()),
        overflown_(size()) {
    if (rves.committed.history != history_size<Law>)
      throw std::invalid_argument("the batch holds the histories of another law");
    packing_of_.write(packing_of_rve_);
    upload(rves.committed);
  }

  void upload(const HostStates& from) override {
    states_.upload(from);
    forget_candidates();
  }
  void copy_committed() override {
    if (!copy_) copy_.emplace(states_.view());
    copy_->take(states_.view());
  }
  std::size_t bring_copy(const HostStates& to) override { return copy_.value().bring(to); }
  void download(const HostStates& to, std::span<const int> rves, bool trial) override {
    states_.download(to, rves, trial);
  }
  DeviceWork advance(std::span<const StrainRequest> requests, const EngineSettings& settings,
                     std::span<RveReport> reports, std::span<const int> rves) override {
    return advance_with<StrainDrive>(requests, settings, reports, rves);
  }
  DeviceWork advance(std::span<const ServoRequest> requests, const EngineSettings& settings,
                     std::span<RveReport> reports, std::span<const int> rves) override {
    if constexpr (Backend::follows_stresses) return advance_with<ServoControl>(requests, settings, reports, rves);
    throw std::invalid_argument("the device follows given motions only: lanes control stresses");
  }
  DeviceWork commit(std::span<const int> kept) override {
    const std::vector<std::uint8_t> changes = states_.commit(kept);  // flags of one byte: one array down, two up
    const std::size_t n = changes.size();
    std::vector<double> skin(n), spent(n), spending(n);
    DeviceWork work{.bytes_up = 2 * n, .bytes_down = n};
    if (kept_.capacity == 0) return work;  // nothing was advanced
    work.bytes_down += kept_.skin.read(skin) + kept_.spent.read(spent) + kept_.spending.read(spending);
    for (std::size_t k = 0; k < n; ++k) {
      if (changes[k] == 0) continue;
      if (spending[k] < 0) skin[k] = -1;
      spent[k] = spending[k];
    }
    work.bytes_up += kept_.skin.write(skin) + kept_.spent.write(spent);
    return work;
  }
  DeviceWork describe(const MicrostructureRequest& wanted, std::span<CommittedSums> out) override {
    const bool tallies = needs_tally(wanted);
    if (tallies) contact_counts_.at_least(size() * static_cast<std::size_t>(packings_.grains()));
    committed_sums_.at_least(size());
    Backend::describe({packings_.exact(), states_.view(), packing_of_.data(), contact_counts_.data(),
                       committed_sums_.data(), network_thresholds(), needs_contact_sums(wanted), tallies});
    return {.bytes_down = committed_sums_.read(out)};
  }

 private:
  std::vector<Packing> all_packings_;
  std::vector<int> packing_of_rve_;
  HeldPackings<Law, Backend> packings_;
  HeldStates<Backend> states_;
  std::optional<StateCopy<Backend>> copy_;  ///< from the first time on that states come down
  double skin_ = -1, overlap_limit_ = -1;   ///< of the settings for which the packings are written
  DeviceArray<int, Backend> packing_of_;
  DeviceArray<std::uint8_t, Backend> overflown_;
  CandidateArrays<Backend> kept_;       ///< by RVE, from evaluation to evaluation
  CandidateArrays<Backend> of_launch_;  ///< by block, of RVEs that run again with more room
  DeviceArray<ContactCounts, Backend> contact_counts_;
  DeviceArray<CommittedSums, Backend> committed_sums_;
  CallArrays<StrainDrive, Backend> strain_;
  CallArrays<ServoControl, Backend> servo_;

  [[nodiscard]] std::size_t size() const { return packing_of_rve_.size(); }
  [[nodiscard]] const Packing& packing(std::size_t rve) const {
    return all_packings_[static_cast<std::size_t>(packing_of_rve_[rve])];
  }
  [[nodiscard]] auto& arrays_of(const StrainDrive*) { return strain_; }
  [[nodiscard]] auto& arrays_of(const ServoControl*) { return servo_; }

  void forget_candidates() {
    if (kept_.capacity > 0) kept_.skin.write(std::vector<double>(size(), -1.0));
  }
  /// Candidates for a launch. Those of RVEs that run again are not kept, since few RVEs would decide the room of all.
  [[nodiscard]] DeviceCandidates candidates(bool again, int blocks, int pairs) {
    if (again) {
      of_launch_.grow(static_cast<std::size_t>(blocks), pairs);
    } else if (kept_.grow(size(), pairs)) {
      forget_candidates();
    }
    return again ? of_launch_.view(true) : kept_.view(false);
  }

  void write_packings(const EngineSettings& settings) {
    if (settings.skin == skin_ && settings.overlap_limit == overlap_limit_) return;
    packings_.write(all_packings_, settings);
    forget_candidates();
    skin_ = settings.skin;
    overlap_limit_ = settings.overlap_limit;
  }

  /// Writes the requests of the RVEs `rves`, in their order.
  template <class Drive>
  std::size_t write_requests(CallArrays<Drive, Backend>& to, std::span<const typename Drive::Request> requests,
                             const EngineSettings& settings, std::span<const int> rves) {
    std::vector<Drive> drives;
    for (const int rve : rves) {
      const auto k = static_cast<std::size_t>(rve);
      drives.emplace_back(requests[k], packings_.scales(packing_of_rve_[k]), settings);
    }
    to.drives.at_least(drives.size());
    to.order.at_least(rves.size());
    to.reports.at_least(rves.size());
    return to.drives.write(drives) + to.order.write(rves);
  }

  template <class Drive>
  [[nodiscard]] BlockBatch<real, Drive> view(CallArrays<Drive, Backend>& of, const DeviceCandidates& candidates) {
    return {packings_.view(),       states_.view(),   candidates,        packing_of_.data(),
            of.order.data(),        of.drives.data(), of.reports.data(), of.samples.data(),
            of.sample_count.data(), of.sample_room,   overflown_.data()};
  }

  /// Runs the RVEs of the call in blocks of one level of room. @param again whether they had too little room before
  template <class Drive>
  void launch(CallArrays<Drive, Backend>& arrays, const EngineSettings& settings, int level, bool again, int blocks) {
    const int pairs = Backend::template room<Law, Drive>(level, packings_.grains());
    const BlockBatch<real, Drive> batch = view(arrays, candidates(again, blocks, pairs));
    if constexpr (Law::has_rolling) {
      if (packings_.classes()) return Backend::template launch<Law, Drive, true>(batch, settings, level, blocks, pairs);
    }
    Backend::template launch<Law, Drive, false>(batch, settings, level, blocks, pairs);
  }

  template <class Drive>
  DeviceWork advance_with(std::span<const typename Drive::Request> requests, const EngineSettings& settings,
                          std::span<RveReport> reports, std::span<const int> rves) {
    if (settings.tangent == TangentKind::loading)
      throw std::invalid_argument("a device finds no loading tangents: engine.backend = \"lanes\" does");
    DeviceWork work;
    if (rves.empty()) return work;
    write_packings(settings);
    auto& arrays = arrays_of(static_cast<const Drive*>(nullptr));
    make_sample_room(arrays, requests);
    std::vector<int> order(rves.begin(), rves.end());
    const auto steps = [&](int rve) {
      const auto k = static_cast<std::size_t>(rve);
      return predicted_steps(requests[k], reports[k].steps);
    };
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return steps(a) > steps(b); });
    const int first = Backend::template level_from<Law, Drive>(0, packings_.grains());
    for (int level = first; !order.empty();
         level = Backend::template level_from<Law, Drive>(level + 1, packings_.grains())) {
      const bool last = level + 1 == Backend::levels;
      work.bytes_up += write_requests<Drive>(arrays, requests, settings, order);
      launch<Drive>(arrays, settings, level, level != first, static_cast<int>(order.size()));
      order = take_answers(arrays, reports, order, last, work);
      work.enlarged += order.size();
    }
    work.bytes_down += append_samples(arrays, requests);
    return work;
  }

  /// Reads the reports of a launch. Returns the RVEs that need more room.
  template <class Drive>
  [[nodiscard]] std::vector<int> take_answers(CallArrays<Drive, Backend>& arrays, std::span<RveReport> reports,
                                              const std::vector<int>& order, bool last, DeviceWork& work) {
    std::vector<RveReport> answers(order.size());
    std::vector<std::uint8_t> overflown(size());
    work.bytes_down += arrays.reports.read(answers) + overflown_.read(overflown);
    std::vector<int> again;
    for (std::size_t q = 0; q < order.size(); ++q) {
      const auto k = static_cast<std::size_t>(order[q]);
      if (overflown[k] != 0 && !last) {
        again.push_back(order[q]);
        continue;
      }
      reports[k] = answers[q];
      work.particle_steps += static_cast<std::size_t>(packing(k).size()) *
                             static_cast<std::size_t>(std::max(reports[k].steps, 0));
    }
    return again;
  }
};

/// Calls body(Instance<Law>) with the law that the RVEs ask for. Grains of several classes have the law with rolling,
/// so that fewer instances are compiled.
template <class Body>
[[nodiscard]] auto choose_law(const RveSet& rves, Precision precision, const Body& body) {
  const bool rolling = rolls(rves.packings) || std::any_of(rves.packings.begin(), rves.packings.end(),
                                                           [](const Packing& p) { return !p.class_of.empty(); });
  return choose_precision(precision, [&]<class real>(Instance<real>) {
    using V = SingleLane<real>;
    return rolling ? body(Instance<EngineLaw<V, true>>{}) : body(Instance<EngineLaw<V, false>>{});
  });
}

/// Holds RVEs by the instance that they ask for.
template <class Backend>
[[nodiscard]] std::unique_ptr<ResidentRves> hold(const RveSet& rves, Precision precision) {
  return choose_law(rves, precision, [&]<class Law>(Instance<Law>) -> std::unique_ptr<ResidentRves> {
    return std::make_unique<ResidentBatch<Law, Backend>>(rves);
  });
}

}  // namespace voussoir::kernels::device
