#pragma once
/// The lock of a run's folder: two processes that write into one folder would destroy one another's results.

#include <filesystem>
#include <memory>
#include <string>

#include "io/file_lock.hpp"

namespace voussoir::host {

inline constexpr const char* run_lock_name = "run.lock";

/// Holds the folder of a run for this process, until it is destroyed. What lies in the folder belongs to it: a tunnel's
/// column, and the runs of a sweep, which hold their own folders besides.
class RunLock {
 public:
  /// Makes the folder, where it is missing, and takes its lock. Throws io::InputError naming process and host where
  /// another process holds the folder, the folder above it, or the column in it, and where a process of another host
  /// left its lock and `take_over` is not set.
  RunLock(const std::filesystem::path& folder, bool take_over);

  /// A sentence for the log where the file system has no locks or the folder was taken over from another host; may be
  /// empty.
  [[nodiscard]] const std::string& note() const { return note_; }

  /// To be called before something is written into the folder. Throws std::runtime_error where another process has
  /// taken the folder over or where it is gone. Returns a sentence for the log, empty where all is as it was.
  [[nodiscard]] std::string confirm() const;

 private:
  std::filesystem::path folder_;
  std::unique_ptr<io::FileLock> lock_;
  std::string note_;
};

/// Throws io::InputError where a process that runs holds the folder, without taking its lock.
void expect_unlocked(const std::filesystem::path& folder);

}  // namespace voussoir::host
