/// Checkpoints: same bits back, damaged files passed over, only the last two kept.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <atomic>
#include <bit>
#include <cstdint>
#include <fstream>
#include <limits>
#include <thread>

#include "io/checkpoint.hpp"
#include "io/checksum.hpp"
#include "tests/throws.hpp"

namespace voussoir::io {
namespace {

namespace fs = std::filesystem;

class CheckpointTest : public testing::Test {
 protected:
  CheckpointTest() { fs::remove_all(folder_); }

  static Checkpoint example(double value) {
    Checkpoint checkpoint;
    checkpoint.put_doubles("displacement", std::vector{value, 0.1, -0.0, std::numeric_limits<double>::denorm_min()});
    checkpoint.put_integers("counts", std::vector<std::int64_t>{1, -2});
    checkpoint.put_text("stage", "gravity");
    checkpoint.put("empty", {});
    return checkpoint;
  }
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const auto& entry : fs::directory_iterator(folder_)) all.push_back(entry.path().filename().string());
    std::sort(all.begin(), all.end());
    return all;
  }
  /// Turns one bit in the middle of a file.
  void damage(const std::string& name) const {
    std::fstream file(folder_ / name, std::ios::in | std::ios::out | std::ios::binary);
    const auto middle = static_cast<std::streamoff>(fs::file_size(folder_ / name) / 2);
    const auto byte = static_cast<char>(file.seekg(middle).get() ^ 1);
    file.seekp(middle).put(byte);
  }

  fs::path folder_ = fs::current_path() / "checkpoints";
  CheckpointStore store_{folder_, "case A"};
};

TEST_F(CheckpointTest, NothingToLoadAtFirst) { EXPECT_FALSE(store_.load_latest().has_value()); }

TEST_F(CheckpointTest, BytesThatAreMadeLateAreTheSame) {
  const std::vector<std::byte> bytes(7, std::byte{5});
  const auto in_pieces = [&bytes](const auto& sink) {
    sink(std::span(bytes).first(3));
    sink(std::span(bytes).subspan(3));
  };
  Checkpoint late = example(1.0);
  late.put_late("grains", {[&bytes] { return bytes.size(); }, in_pieces});
  EXPECT_TRUE(late.has("grains"));
  Checkpoint at_once = example(1.0);
  at_once.put("grains", bytes);
  const std::size_t size = store_.save(1, late);
  EXPECT_EQ(size, fs::file_size(folder_ / "checkpoint_0001.bin"));
  EXPECT_EQ(store_.load_latest()->checkpoint.blobs(), at_once.blobs());
  EXPECT_EQ(late.get("grains"), bytes);
  EXPECT_EQ(late.blobs(), at_once.blobs());

  late.put_late("grains", {[] { return std::size_t{8}; }, in_pieces});
  expect_throws<std::logic_error>([&] { store_.save(2, late); }, "has 7 bytes and not 8");
  EXPECT_EQ(store_.load_latest()->increment, 1);
}

TEST_F(CheckpointTest, SameBitsBack) {
  const Checkpoint saved = example(1.0 / 3);
  store_.save(4, saved);
  const auto loaded = store_.load_latest();
  ASSERT_TRUE(loaded.has_value());
  EXPECT_EQ(loaded->increment, 4);
  EXPECT_TRUE(loaded->skipped.empty());
  EXPECT_EQ(loaded->checkpoint.blobs(), saved.blobs());
  EXPECT_EQ(std::bit_cast<std::uint64_t>(loaded->checkpoint.get_doubles("displacement")[2]),
            std::bit_cast<std::uint64_t>(-0.0));
  EXPECT_EQ(loaded->checkpoint.get_doubles("displacement")[0], 1.0 / 3);
  EXPECT_EQ(loaded->checkpoint.get_integers("counts"), (std::vector<std::int64_t>{1, -2}));
  EXPECT_EQ(loaded->checkpoint.get_text("stage"), "gravity");
  expect_throws<std::runtime_error>([&] { static_cast<void>(loaded->checkpoint.get("velocity")); },
                                    "has no \"velocity\"");
  expect_throws<std::runtime_error>([&] { static_cast<void>(loaded->checkpoint.get_doubles("stage")); },
                                    "\"stage\" has 7 bytes");
}

TEST_F(CheckpointTest, TheLastTwoAreKept) {
  for (int increment = 8; increment <= 11; ++increment) store_.save(increment, example(increment));
  EXPECT_EQ(names(), (std::vector<std::string>{"checkpoint_0010.bin", "checkpoint_0011.bin"}));
  store_.save(10, example(10));  // a run resumed from increment 9 comes by here again
  EXPECT_EQ(names(), (std::vector<std::string>{"checkpoint_0010.bin"}));
}

TEST_F(CheckpointTest, DamagedOneIsPassedOver) {
  store_.save(1, example(1));
  store_.save(2, example(2));
  damage("checkpoint_0002.bin");
  const auto loaded = store_.load_latest();
  ASSERT_TRUE(loaded.has_value());
  EXPECT_EQ(loaded->increment, 1);
  EXPECT_EQ(loaded->checkpoint.get_doubles("displacement")[0], 1.0);
  ASSERT_EQ(loaded->skipped.size(), 1U);
  EXPECT_NE(loaded->skipped[0].find("checkpoint_0002.bin"), std::string::npos);
  damage("checkpoint_0001.bin");
  expect_throws<std::runtime_error>([&] { static_cast<void>(store_.load_latest()); }, "no checkpoint is readable");
}

TEST_F(CheckpointTest, AnyTruncationIsNoticed) {
  store_.save(1, example(1));
  store_.save(2, example(2));
  const auto path = folder_ / "checkpoint_0002.bin";
  for (auto size = fs::file_size(path); size > 0; size -= std::min<std::uintmax_t>(size, 7)) {
    fs::resize_file(path, size - 1);
    EXPECT_EQ(store_.load_latest()->increment, 1) << size;
  }
}

TEST_F(CheckpointTest, KilledWriterLeavesTheFormerOne) {
  store_.save(1, example(1));
  std::ofstream(folder_ / "checkpoint_0002.bin.tmp") << "half a file";
  EXPECT_EQ(store_.load_latest()->increment, 1);
  store_.clear();
  EXPECT_TRUE(names().empty());
}

TEST_F(CheckpointTest, WhatIsNoRegularFileIsSkippedAndNotWaitedFor) {
  store_.save(1, example(1));
  const auto path = folder_ / "checkpoint_0002.bin";
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  EXPECT_EQ(store_.load_latest()->increment, 1);
  EXPECT_NE(store_.load_latest()->skipped.at(0).find("is a pipe or a device"), std::string::npos);
  fs::remove(path);
  fs::create_directory(path);
  EXPECT_NE(store_.load_latest()->skipped.at(0).find("is a folder"), std::string::npos);
}

TEST_F(CheckpointTest, AnotherCaseIsRefused) {
  store_.save(1, example(1));
  expect_throws<std::runtime_error>([&] { static_cast<void>(CheckpointStore(folder_, "case B").load_latest()); },
                                    "belongs to another case (fingerprint case A, this case has case B)");
}

TEST_F(CheckpointTest, UnwritableFolderIsAnError) {
  std::ofstream(folder_) << "a file where the folder should be";
  expect_throws<std::runtime_error>([&] { store_.save(1, example(1)); }, "checkpoints");
}

TEST(ChecksumTest, IsOfTheSequenceNotOfItsPiecesAndSeesEveryBit) {
  std::vector<std::byte> bytes(61);
  for (std::size_t k = 0; k < bytes.size(); ++k) bytes[k] = static_cast<std::byte>(37 * k);
  const auto sum_of = [](std::span<const std::byte> all, std::size_t piece) {
    Checksum sum;
    for (std::size_t at = 0; at < all.size(); at += piece) sum.add(all.subspan(at, std::min(piece, all.size() - at)));
    return sum.value();
  };
  const std::uint64_t whole = sum_of(bytes, bytes.size());
  for (const std::size_t piece : {1, 3, 8, 11, 40}) EXPECT_EQ(sum_of(bytes, piece), whole) << piece;
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    auto damaged = bytes;
    damaged[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
    EXPECT_NE(sum_of(damaged, 8), whole) << bit;
  }
  EXPECT_NE(sum_of(std::vector<std::byte>(8), 8), sum_of(std::vector<std::byte>(9), 8));
}

// A folder that something else changes while checkpoints are written: each save works or says what is wrong.
TEST_F(CheckpointTest, AFolderThatChangesUnderTheRunIsAnError) {
  std::atomic<bool> stop = false;
  std::thread other([&] {
    while (!stop) {
      for (int k = 1; k < 400; ++k) {
        std::error_code ignored;
        fs::remove(folder_ / fmt::format("checkpoint_{:04}.bin", k), ignored);
      }
    }
  });
  int refused = 0;
  for (int k = 1; k < 400 && refused < 3; ++k) {
    try {
      store_.save(k, example(k));
    } catch (const std::exception&) {
      ++refused;
    }
  }
  stop = true;
  other.join();
  EXPECT_GT(refused, 0);  // in the mean every other save is hit
}

}  // namespace
}  // namespace voussoir::io
