/// Locks between processes: who gets one, what is left of a process that was killed, and file systems without locks.

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <string>

#include "io/file_lock.hpp"

namespace voussoir::io {
namespace {

namespace fs = std::filesystem;
using Refusal = LockAttempt::Refusal;
using Standing = FileLock::Standing;

int no_locks(int /*file*/) {
  errno = ENOLCK;
  return -1;
}

class FileLockTest : public testing::Test {
 protected:
  FileLockTest() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }

  /// A process that holds the lock until it is killed; returns when it has the lock.
  [[nodiscard]] pid_t holder(FileLock::Ask ask = FileLock::ask_kernel) const {
    int pipe_ends[2];
    EXPECT_EQ(pipe(pipe_ends), 0);
    const pid_t child = fork();
    if (child == 0) {
      const LockAttempt attempt = LockAttempt::make(file_, false, ask);
      const char said = attempt.lock ? '1' : '0';
      EXPECT_EQ(write(pipe_ends[1], &said, 1), 1);
      for (;;) pause();
    }
    char said = '?';
    EXPECT_EQ(read(pipe_ends[0], &said, 1), 1);
    EXPECT_EQ(said, '1');
    close(pipe_ends[0]);
    close(pipe_ends[1]);
    return child;
  }
  static void end(pid_t child) {
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
  }
  [[nodiscard]] std::string text() const {
    std::ifstream file(file_);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  /// Turns the lock file into one of another host.
  void move_to_another_host() const {
    std::string all = text();
    const std::size_t at = all.find("host ") + 5;
    all.replace(at, all.find('\n', at) - at, "elsewhere");
    std::ofstream(file_) << all;
  }

  fs::path folder_ = fs::current_path() / "locks";
  fs::path file_ = folder_ / "a.lock";
};

TEST_F(FileLockTest, TheFileNamesTheHolderAndIsRemovedAtTheEnd) {
  {
    const LockAttempt attempt = LockAttempt::make(file_, false);
    ASSERT_TRUE(attempt.lock);
    EXPECT_TRUE(attempt.lock->by_kernel());
    const auto holder = running_holder(file_);
    ASSERT_TRUE(holder);
    EXPECT_EQ(holder->process, getpid());
    EXPECT_TRUE(holder->on_this_host());
    EXPECT_EQ(attempt.lock->confirm(), Standing::ours);
  }
  EXPECT_FALSE(fs::exists(file_));
  EXPECT_FALSE(running_holder(file_));
}

TEST_F(FileLockTest, ARunningHolderRefusesAndAKilledOneDoesNotBlock) {
  const pid_t child = holder();
  const LockAttempt refused = LockAttempt::make(file_, true);  // nothing takes over from a process that runs
  EXPECT_FALSE(refused.lock);
  EXPECT_EQ(refused.refusal, Refusal::running);
  ASSERT_TRUE(refused.holder);
  EXPECT_EQ(refused.holder->process, child);
  EXPECT_TRUE(fs::exists(file_));
  end(child);
  EXPECT_TRUE(fs::exists(file_));
  EXPECT_FALSE(running_holder(file_));
  EXPECT_TRUE(LockAttempt::make(file_, false).lock);
}

TEST_F(FileLockTest, AnotherHostIsAskedForOnlyWhereTheUserSaysSo) {
  end(holder());
  move_to_another_host();
  const LockAttempt refused = LockAttempt::make(file_, false);
  EXPECT_EQ(refused.refusal, Refusal::other_host);
  ASSERT_TRUE(refused.holder);
  EXPECT_EQ(refused.holder->host, "elsewhere");
  EXPECT_NE(text().find("elsewhere"), std::string::npos);
  const LockAttempt taken = LockAttempt::make(file_, true);
  EXPECT_TRUE(taken.lock);
  ASSERT_TRUE(taken.holder);
  EXPECT_EQ(taken.holder->host, "elsewhere");
}

TEST_F(FileLockTest, AFileOfAnotherKindIsLeftAsItIs) {
  std::ofstream(file_) << "my notes\n";
  EXPECT_EQ(LockAttempt::make(file_, true).refusal, Refusal::not_a_lock);
  EXPECT_EQ(text(), "my notes\n");
  std::ofstream(file_) << "voussoir lo";  // a full disk may cut the text off
  EXPECT_TRUE(LockAttempt::make(file_, false).lock);
}

TEST_F(FileLockTest, ALockFileThatAUserRemovedIsMadeAnew) {
  const LockAttempt attempt = LockAttempt::make(file_, false);
  fs::remove(file_);
  EXPECT_EQ(attempt.lock->confirm(), Standing::made_anew);
  EXPECT_EQ(attempt.lock->confirm(), Standing::ours);
  EXPECT_EQ(LockAttempt::make(file_, false).refusal, Refusal::running);
}

TEST_F(FileLockTest, ALockFileOfAnotherProcessIsNotTouched) {
  {
    const LockAttempt attempt = LockAttempt::make(file_, false);
    fs::remove(file_);
    const pid_t child = holder();
    EXPECT_EQ(attempt.lock->confirm(), Standing::taken_over);
    end(child);
  }
  EXPECT_TRUE(fs::exists(file_));
}

TEST_F(FileLockTest, OtherBytesInItsOwnFileAreReplacedByItsText) {
  const LockAttempt attempt = LockAttempt::make(file_, false);
  const std::string whole = text();
  for (const char* bytes : {"", "my notes\n"}) {
    std::ofstream(file_) << bytes;
    EXPECT_EQ(attempt.lock->confirm(), Standing::rewritten);
    EXPECT_EQ(text(), whole);
  }
  EXPECT_EQ(attempt.lock->confirm(), Standing::ours);
}

TEST_F(FileLockTest, SomethingElseOfItsNameIsNoOtherProcess) {
  const LockAttempt attempt = LockAttempt::make(file_, false);
  fs::remove(file_);
  std::ofstream(file_) << "my notes\n";
  EXPECT_EQ(attempt.lock->confirm(), Standing::replaced);
  fs::remove(file_);
  fs::create_directory(file_);
  EXPECT_EQ(attempt.lock->confirm(), Standing::replaced);
}

TEST_F(FileLockTest, WhatIsNoRegularFileIsNeverWaitedFor) {
  ASSERT_EQ(mkfifo(file_.c_str(), 0600), 0);
  EXPECT_EQ(LockAttempt::make(file_, true).refusal, Refusal::not_a_lock);
  EXPECT_FALSE(running_holder(file_));
  fs::remove(file_);
  fs::create_directory(file_);
  EXPECT_EQ(LockAttempt::make(file_, true).refusal, Refusal::not_a_lock);
  EXPECT_FALSE(running_holder(file_));
  fs::remove(file_);
  fs::create_symlink("/dev/zero", file_);
  EXPECT_EQ(LockAttempt::make(file_, true).refusal, Refusal::not_a_lock);
}

TEST_F(FileLockTest, AFolderThatIsGoneIsSaid) {
  const LockAttempt attempt = LockAttempt::make(file_, false);
  fs::rename(folder_, folder_.string() + "_moved");
  EXPECT_EQ(attempt.lock->confirm(), Standing::gone);
  fs::create_directories(folder_);  // another folder of the same name is not the one that is held
  EXPECT_EQ(attempt.lock->confirm(), Standing::gone);
  EXPECT_FALSE(fs::exists(file_));
  EXPECT_EQ(LockAttempt::make(fs::path(folder_.string() + "_moved") / "a.lock", false).refusal, Refusal::running);
  fs::remove_all(folder_.string() + "_moved");
}

TEST_F(FileLockTest, OfManyAtOnceExactlyOneGoesOn) {
  constexpr int many = 6;
  for (int round = 0; round < 15; ++round) {
    fs::remove(file_);
    int gate[2], answers[2], hold[2];
    ASSERT_TRUE(pipe(gate) == 0 && pipe(answers) == 0 && pipe(hold) == 0);
    for (int k = 0; k < many; ++k) {
      if (fork() != 0) continue;
      close(gate[1]);
      close(hold[1]);
      char nothing = 0;
      static_cast<void>(!read(gate[0], &nothing, 1));  // returns for all when the parent closes the gate
      const LockAttempt attempt = LockAttempt::make(file_, false);
      const char answer = attempt.lock ? 1 : 0;
      static_cast<void>(!write(answers[1], &answer, 1));
      static_cast<void>(!read(hold[0], &nothing, 1));  // the lock is kept until all have tried
      _exit(0);
    }
    close(gate[0]);
    close(gate[1]);
    int got = 0;
    for (int k = 0; k < many; ++k) {
      char answer = 0;
      ASSERT_EQ(read(answers[0], &answer, 1), 1);
      got += answer;
    }
    EXPECT_EQ(got, 1);
    for (const int end : {hold[0], hold[1], answers[0], answers[1]}) close(end);
    for (int k = 0; k < many; ++k) wait(nullptr);
  }
}

TEST_F(FileLockTest, WithoutLocksTheTextKeepsOthersOut) {
  const pid_t child = holder(no_locks);
  const LockAttempt refused = LockAttempt::make(file_, true, no_locks);
  EXPECT_EQ(refused.refusal, Refusal::running);
  ASSERT_TRUE(refused.holder);
  EXPECT_EQ(refused.holder->process, child);
  end(child);
  const LockAttempt attempt = LockAttempt::make(file_, false, no_locks);
  ASSERT_TRUE(attempt.lock);
  EXPECT_FALSE(attempt.lock->by_kernel());
}

TEST_F(FileLockTest, WithoutLocksANumberThatIsUsedAgainDoesNotBlock) {
  end(holder(no_locks));
  std::string all = text();
  const std::size_t at = all.find("process ") + 8;
  all.replace(at, all.find('\n', at) - at, std::to_string(getpid()));  // this process was born at another time
  std::ofstream(file_) << all;
  EXPECT_TRUE(LockAttempt::make(file_, false, no_locks).lock);
}

TEST_F(FileLockTest, AFolderThatCannotBeWrittenIsAFailure) {
  EXPECT_THROW(static_cast<void>(LockAttempt::make(folder_ / "missing" / "a.lock", false)), std::exception);
}

}  // namespace
}  // namespace voussoir::io
