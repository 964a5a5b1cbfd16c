// The memory of a block: the actions of pairs are also the scratch of sums and bins, for which they must have room
// however few pairs a block is made for.

#include <gtest/gtest.h>

#include "kernels/contact/engine_law.hpp"
#include "kernels/course/drives.hpp"
#include "kernels/device/block_run.hpp"
#include "tests/device_blocks.hpp"
#include "tests/same_answers.hpp"

namespace voussoir::kernels {
namespace {

template <class real>
using Memory = device::BlockMemory<EngineLaw<SingleLane<real>, true>, StrainDrive, device::InMemory>;

template <class real>
void expect_room() {
  for (const int grains : {4, 300}) {
    for (const int pairs : {1, 64, 2100}) {
      for (const int threads : {1, 16, 31, 1024}) {
        SCOPED_TRACE(testing::Message() << grains << " grains, " << pairs << " pairs, " << threads << " threads");
        const Memory<real> at(device::no_memory(), device::no_memory(), grains, pairs, threads);
        const auto room = static_cast<std::size_t>(reinterpret_cast<char*>(at.row) -
                                                   reinterpret_cast<char*>(at.action));
        const int groups = (threads + 15) / 16;
        EXPECT_GE(room, sizeof(double) * static_cast<std::size_t>(6 * (threads + groups))) << "sums";
        EXPECT_GE(room, sizeof(int) * static_cast<std::size_t>(4 * grains + 1)) << "bins";
        EXPECT_GE(room, 4 * sizeof(real) * static_cast<std::size_t>(pairs)) << "actions";
        EXPECT_GE(room, sizeof(int) * static_cast<std::size_t>(device::candidates_per_pair * pairs)) << "candidates";
      }
    }
  }
}

TEST(BlockMemory, ActionsHaveRoomForTheScratch) {
  expect_room<float>();
  expect_room<double>();
}

TEST(BlockMemory, ManyThreadsAnswerWithRoomForHardlyAPair) {
  // Ten grains touch in a row around the cell, so that the list has ten pairs. The room for twenty is far less than the
  // sums of 48 threads need.
  const double d = 2e-3, length = 9.99 * d;
  reference::Rve row = reference::loose_packing(10, d / 2, d / 2, 4, reference::Material{});
  for (std::size_t i = 0; i < 10; ++i) row.positions[i] = {length * static_cast<double>(i) / 10, length / 2};
  row.radii.assign(10, d / 2);
  row.rotations.assign(10, 0.0);
  row.cell = {length, 0, 0, length};
  const RveBatch batch = clones(row, 2);
  EngineSettings settings;
  settings.guard_interval = 2;
  const std::vector<StrainRequest> requests(2, {.f_rel = {0.999, 0, 0, 0.999}, .strain_steps = 12, .hold_cap = 4});
  std::vector<RveReport> reports(2), expected(2);
  for (const Precision precision : {Precision::float32, Precision::float64}) {
    settings.precision = precision;
    const Blocks usual{BlockKind::in_memory, 48}, few{BlockKind::in_memory, 48, 20};
    advance_held(*hold(batch, precision, usual), requests, settings, expected, first_rves(2));
    const auto work = advance_held(*hold(batch, precision, few), requests, settings, reports, first_rves(2));
    EXPECT_EQ(work.enlarged, 0U) << "the test wants a block with little room";
    EXPECT_EQ(expected[0].contacts, 10) << "the row has come apart: the test shows nothing";
    for (std::size_t k = 0; k < 2; ++k) expect_same_report(reports[k], expected[k], k);
  }
}

}  // namespace
}  // namespace voussoir::kernels
