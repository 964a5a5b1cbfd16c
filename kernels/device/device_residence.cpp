#include "kernels/device/device_residence.hpp"

#include <numeric>
#include <stdexcept>

namespace voussoir::kernels::device {

namespace {

class DeviceResidence final : public Residence {
 public:
  DeviceResidence(const RveBatch& batch, std::shared_ptr<Device> device, Precision precision)
      : device_(std::move(device)), precision_(precision), rves_(device_->hold(plain(batch), precision)) {
    all_.resize(batch.size());
    std::iota(all_.begin(), all_.end(), 0);
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
    work_ += rves_->commit(kept);
    ahead_ = true;
  }
  void bring(const RveStates& to) override {
    if (!ahead_) return;
    download(to, all_);
    ahead_ = false;
  }
  void bring_one(const RveStates& to, int rve) override {
    if (ahead_) download(to, std::span(&rve, 1));
  }
  void describe(const MicrostructureRequest& wanted, std::span<CommittedSums> out) override {
    if (!ahead_) throw std::logic_error("the host describes the states that it has");
    work_ += rves_->describe(wanted, out);
  }
  void forget() override {
    outdated_ = true;
    ahead_ = false;
  }
  [[nodiscard]] bool is_ahead() const override { return ahead_; }
  [[nodiscard]] const DeviceWork& work() const { return work_; }

 private:
  std::shared_ptr<Device> device_;  ///< lives as long as its RVEs
  Precision precision_;
  std::unique_ptr<ResidentRves> rves_;
  std::vector<int> all_;
  bool ahead_ = false;     ///< the device's committed states are newer
  bool outdated_ = false;  ///< the host's are
  DeviceWork work_;

  void download(const RveStates& to, std::span<const int> rves) {
    const HostStates states = plain(to);
    rves_->download(states, rves, false);
    work_.bytes_down += rves.size() * bytes_of_rve(states);
  }
  template <class Request>
  Work advance_with(const RveBatch& batch, std::span<const Request> requests, const EngineSettings& settings,
                    std::span<RveReport> reports, std::span<const int> rves) {
    if (settings.precision != precision_) throw std::logic_error("a batch on a device keeps its precision");
    if (outdated_) {
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
