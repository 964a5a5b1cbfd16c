// What a batch knows of the device on which it resides: when states cross the border, and what happens beside it. The
// device is a list of the calls that it received.

#include "kernels/device/device_residence.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

#include "kernels/describe_committed.hpp"
#include "tests/engine_support.hpp"

namespace voussoir::kernels {
namespace {

constexpr double mark = 7.25;  ///< the rotation of the first grain in states that come from the device

/// What a device was asked for, and whether it may bring states yet.
struct Calls {
  std::string names;
  std::promise<void> may_bring;
  bool fails = false;
};

class ListedRves final : public device::ResidentRves {
 public:
  explicit ListedRves(Calls& calls) : calls_(calls), may_bring_(calls.may_bring.get_future()) {}
  void upload(const device::HostStates& from) override { note(from.rotation[0] == mark ? "upload-newer" : "upload"); }
  void copy_committed() override { note("copy"); }
  std::size_t bring_copy(const device::HostStates& to) override {
    may_bring_.wait();
    if (calls_.fails) throw std::runtime_error("the device failed");
    to.rotation[0] = mark;
    return 100;
  }
  void download(const device::HostStates&, std::span<const int>, bool) override { note("download"); }
  device::DeviceWork advance(std::span<const StrainRequest>, const EngineSettings&, std::span<RveReport>,
                             std::span<const int>) override {
    note("advance");
    return {.particle_steps = 3, .bytes_up = 10, .bytes_down = 20};
  }
  device::DeviceWork advance(std::span<const ServoRequest>, const EngineSettings&, std::span<RveReport>,
                             std::span<const int>) override {
    return {};
  }
  device::DeviceWork commit(std::span<const int>) override {
    note("commit");
    return {.bytes_up = 1, .bytes_down = 2};
  }
  device::DeviceWork describe(const MicrostructureRequest&, std::span<CommittedSums> out) override {
    note("describe");
    out[0].cell[0] = out[0].cell[3] = mark;
    return {.bytes_down = 5};
  }

 private:
  Calls& calls_;
  std::shared_future<void> may_bring_;

  void note(const std::string& name) { calls_.names += name + " "; }
};

class ListedDevice final : public device::Device {
 public:
  explicit ListedDevice(Calls& calls) : calls_(calls) {}
  [[nodiscard]] std::string name() const override { return "listed"; }
  [[nodiscard]] std::unique_ptr<device::ResidentRves> hold(const device::RveSet&, Precision) override {
    return std::make_unique<ListedRves>(calls_);
  }

 private:
  Calls& calls_;
};

class DeviceResidence : public testing::Test {
 protected:
  Calls calls_;
  RveBatch batch_;

  void SetUp() override {
    Packing two;
    two.radii = {1e-3, 1e-3};
    batch_ = make_batch({two}, {0, 0});
    device::reside(batch_, std::make_shared<ListedDevice>(calls_), Precision::float32);
  }
  void advance_once() {
    const std::vector<StrainRequest> requests(batch_.size());
    std::vector<RveReport> reports(batch_.size());
    advance(batch_, std::span<const StrainRequest>(requests), EngineSettings{.precision = Precision::float32}, reports);
  }
};

TEST_F(DeviceResidence, BringsStatesOnlyAfterACommit) {
  calls_.may_bring.set_value();
  bring_committed(batch_);
  EXPECT_FALSE(begin_bringing_committed(batch_).valid());
  advance_once();
  commit(batch_);
  bring_committed(batch_);
  EXPECT_EQ(batch_.committed.rotation(0, 0), mark);
  bring_committed(batch_);
  EXPECT_EQ(calls_.names, "advance commit copy ");
}

TEST_F(DeviceResidence, AdvancesWhileStatesArrive) {
  commit(batch_);
  const std::shared_future<void> arriving = begin_bringing_committed(batch_);
  advance_once();
  EXPECT_EQ(calls_.names, "commit copy advance ") << "the evaluation waited for the states";
  EXPECT_NE(arriving.wait_for(std::chrono::seconds(0)), std::future_status::ready);
  calls_.may_bring.set_value();
  arriving.get();
  EXPECT_EQ(batch_.committed.rotation(0, 0), mark);
}

TEST_F(DeviceResidence, GivesADevicesFailureToWhoeverWaitsForTheStates) {
  calls_.fails = true;
  calls_.may_bring.set_value();
  commit(batch_);
  const std::shared_future<void> arriving = begin_bringing_committed(batch_);
  EXPECT_THROW(arriving.get(), std::runtime_error);
  EXPECT_THROW(bring_committed(batch_), std::runtime_error) << "the arrays do not have the states";
  calls_.fails = false;
  commit(batch_);
  EXPECT_NO_THROW(bring_committed(batch_));
}

TEST_F(DeviceResidence, TakesTheHostsStatesWhereTheyWereWrittenTo) {
  calls_.may_bring.set_value();
  advance_once();
  commit(batch_);
  bring_committed(batch_);
  forget_candidates(batch_);  // who writes committed states calls it
  EXPECT_FALSE(batch_.residence->is_ahead());
  advance_once();
  advance_once();
  EXPECT_EQ(calls_.names, "advance commit copy upload-newer advance advance ");
}

TEST_F(DeviceResidence, DescribesWhatItHasWhileStatesComeDown) {
  std::vector<CommittedSummary> out(batch_.size());
  commit(batch_);
  const std::shared_future<void> arriving = begin_bringing_committed(batch_);
  describe_committed(batch_, {}, out);  // nothing may be brought yet, and nobody waits for it
  EXPECT_EQ(out[0].cell_area, mark * mark);
  calls_.may_bring.set_value();
  arriving.get();
  EXPECT_EQ(calls_.names, "commit copy describe ");
}

TEST_F(DeviceResidence, LetsTheHostDescribeWhatTheHostHasWritten) {
  calls_.may_bring.set_value();
  std::vector<CommittedSummary> out(batch_.size());
  commit(batch_);
  bring_committed(batch_);
  forget_candidates(batch_);
  describe_committed(batch_, {}, out);
  EXPECT_NE(out[0].cell_area, mark * mark);
  advance_once();
  describe_committed(batch_, {}, out);
  EXPECT_EQ(out[0].cell_area, mark * mark);
  EXPECT_EQ(calls_.names, "commit copy upload-newer advance describe ");
}

TEST_F(DeviceResidence, BringsOneStateWhereTheDeviceIsAhead) {
  calls_.may_bring.set_value();
  bring_committed(batch_, 0);
  commit(batch_);
  bring_committed(batch_, 0);
  EXPECT_TRUE(batch_.residence->is_ahead());
  bring_committed(batch_);
  bring_committed(batch_, 0);
  EXPECT_EQ(calls_.names, "commit download copy ");
}

TEST_F(DeviceResidence, CountsWhatCrossesTheBus) {
  calls_.may_bring.set_value();
  advance_once();
  commit(batch_);
  bring_committed(batch_);
  const device::DeviceWork work = device::device_work(batch_);
  EXPECT_EQ(work.particle_steps, 3U);
  EXPECT_EQ(work.bytes_up, 11U);
  EXPECT_EQ(work.bytes_down, 122U);
}

}  // namespace
}  // namespace voussoir::kernels
