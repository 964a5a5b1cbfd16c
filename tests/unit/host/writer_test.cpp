// The thread that writes: one job at a time, failures that are met once, and an end that loses no job.
#include "host/record/writer.hpp"

#include <gtest/gtest.h>
#include <signal.h>

#include <atomic>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include "tests/throws.hpp"

namespace voussoir::host {
namespace {

/// Shuts a door in front of a job.
class Door {
 public:
  void open() { promise_.set_value(); }
  void pass() { future_.wait(); }

 private:
  std::promise<void> promise_;
  std::shared_future<void> future_ = promise_.get_future().share();
};

TEST(Writer, DoesOneJobAfterAnother) {
  std::vector<int> done;  // no lock: the jobs follow one another, and `wait` comes before the last look
  Writer writer;
  EXPECT_TRUE(writer.idle());
  for (int k = 0; k < 1000; ++k) writer.submit([&done, k] { done.push_back(k); });
  writer.wait();
  ASSERT_EQ(done.size(), 1000U);
  for (int k = 0; k < 1000; ++k) EXPECT_EQ(done[static_cast<std::size_t>(k)], k);
}

TEST(Writer, LetsTheOtherThreadGoOnUntilTheNextJob) {
  Door door;
  std::atomic<bool> second = false;
  Writer writer;
  writer.submit([&] { door.pass(); });
  EXPECT_FALSE(writer.idle());
  std::future<void> next = std::async(std::launch::async, [&] { writer.submit([&] { second = true; }); });
  EXPECT_EQ(next.wait_for(std::chrono::milliseconds(50)), std::future_status::timeout) << "two jobs at a time";
  EXPECT_FALSE(second);
  door.open();
  next.get();
  writer.wait();
  EXPECT_TRUE(second);
  EXPECT_TRUE(writer.idle());
}

TEST(Writer, TellsAFailureOnceAndBeginsNoOtherJobBefore) {
  bool second = false;
  Writer writer;
  writer.submit([] { throw std::runtime_error("the disk is full"); });
  expect_throws<std::runtime_error>([&] { writer.submit([&] { second = true; }); }, "the disk is full");
  writer.wait();
  EXPECT_FALSE(second) << "files behind the one that failed must not be written";
  writer.submit([&] { second = true; });
  writer.wait();
  EXPECT_TRUE(second);
  writer.submit([] { throw std::runtime_error("again"); });
  expect_throws<std::runtime_error>([&] { writer.wait(); }, "again");
  writer.wait();
}

TEST(Writer, EndsBehindItsJob) {
  std::atomic<bool> done = false;
  {
    Writer writer;
    writer.submit([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      done = true;
    });
  }
  EXPECT_TRUE(done);
  {
    Writer without_a_job;
  }
  Writer failed;
  failed.submit([] { throw std::runtime_error("nobody asks"); });
}

TEST(Writer, LeavesNothingOfAJobBehind) {
  const auto held = std::make_shared<int>(1);
  Writer writer;
  writer.submit([held] {});
  writer.wait();
  EXPECT_EQ(held.use_count(), 1) << "what a job holds would be held until the next one";
}

/// A request to stop is for the thread that computes.
TEST(Writer, GetsNoSignals) {
  sigset_t blocked, before, after;
  pthread_sigmask(SIG_BLOCK, nullptr, &before);
  Writer writer;
  writer.submit([&] { pthread_sigmask(SIG_BLOCK, nullptr, &blocked); });
  writer.wait();
  pthread_sigmask(SIG_BLOCK, nullptr, &after);
  for (const int signal : {SIGINT, SIGTERM, SIGUSR1, SIGHUP, SIGXCPU}) {
    EXPECT_EQ(sigismember(&blocked, signal), 1) << signal;
    EXPECT_EQ(sigismember(&after, signal), sigismember(&before, signal)) << signal;
  }
}

}  // namespace
}  // namespace voussoir::host
