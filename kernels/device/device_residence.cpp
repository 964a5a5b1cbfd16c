#include "kernels/device/device_residence.hpp"

#include <stdexcept>

namespace voussoir::kernels::device {

namespace {

class DeviceResidence final : public Residence {
 public:
  DeviceResidence(const RveBatch& batch, std::shared_ptr<Device> device, Precision precision)
      : device_(std::move(device)), precision_(precision), rves_(device_->hold(plain(batch), precision)) {}
  ~DeviceResidence() override {
    if (arriving_.valid()) arriving_.wait();
  }

  Work advance(const RveBatch& batch, std::span<const StrainRequest> requests, const EngineSettings& settings,
               std::span<RveReport> reports, std::span<const int> rves) override {
    return advance_with(batch, requests, settings, reports, rves);
  }
  Work advance(const RveBatch& batch, std::span<const ServoRequest> requests, const EngineSettings& settings,
               std::span<RveReport> reports, std::span<const int> rves) override {
    return advance_with(batch, requests, settings, reports, rves);
  }
  void commit(std::span<const int> kept) override {
    if (outdated_) throw std::logic_error("states that the host has written since were not advanced");
    work_ += rves_->commit(kept);
    ahead_ = true;
  }
  [[nodiscard]] std::shared_future<void> begin_bringing(const RveStates& to) override {
    if (!ahead_) return arriving_;
    if (arriving_.valid()) arriving_.wait();
    rves_->copy_committed();
    ahead_ = false;
    arriving_ = std::async(std::launch::async, [this, to] { bytes_brought_ += rves_->bring_copy(plain(to)); }).share();
    return arriving_;
  }
  void bring_one(const RveStates& to, int rve) override {
    if (arriving_.valid()) {
      if (!ahead_) return arriving_.get();
      arriving_.wait();
    }
    if (!ahead_) return;
    const HostStates states = plain(to);
    rves_->download(states, std::span(&rve, 1), false);
    work_.bytes_down += bytes_of_rve(states);
  }
  void describe(const MicrostructureRequest& wanted, std::span<CommittedSums> out) override {
    if (outdated_) throw std::logic_error("a device cannot describe states that it does not have");
    work_ += rves_->describe(wanted, out);
  }
  [[nodiscard]] bool has_committed() const override { return !outdated_; }
  void forget() override {
    outdated_ = true;
    ahead_ = false;
  }
  [[nodiscard]] bool is_ahead() const override { return ahead_; }
  [[nodiscard]] DeviceWork work() const {
    if (arriving_.valid()) arriving_.wait();
    DeviceWork all = work_;
    all.bytes_down += bytes_brought_;
    return all;
  }

 private:
  std::shared_ptr<Device> device_;  ///< lives as long as its RVEs
  Precision precision_;
  std::unique_ptr<ResidentRves> rves_;
  std::shared_future<void> arriving_;  ///< the states that come down, or came down last
  bool ahead_ = false;                 ///< the device's committed states are newer
  bool outdated_ = false;              ///< the host's are
  DeviceWork work_;
  std::size_t bytes_brought_ = 0;  ///< of states; the thread that brings them counts

  template <class Request>
  Work advance_with(const RveBatch& batch, std::span<const Request> requests, const EngineSettings& settings,
                    std::span<RveReport> reports, std::span<const int> rves) {
    if (settings.precision != precision_) throw std::logic_error("a batch on a device keeps its precision");
    if (outdated_) {
      if (arriving_.valid()) arriving_.get();
      const HostStates states = plain(batch.committed);
      rves_->upload(states);
      work_.bytes_up += batch.size() * bytes_of_rve(states);
    }
    outdated_ = false;
    const DeviceWork did = rves_->advance(requests, settings, reports, rves);
    work_ += did;
    return {.particle_steps = did.particle_steps, .lane_steps = did.particle_steps};
  }
};

}  // namespace

void reside(RveBatch& batch, const std::shared_ptr<Device>& device, Precision precision) {
  batch.residence = std::make_shared<DeviceResidence>(batch, device, precision);
}

DeviceWork device_work(const RveBatch& batch) {
  const auto* const on_device = dynamic_cast<const DeviceResidence*>(batch.residence.get());
  return on_device == nullptr ? DeviceWork{} : on_device->work();
}

}  // namespace voussoir::kernels::device
