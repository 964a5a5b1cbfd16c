#pragma once
/// Locks of packings in a folder that several processes share: a packing is made by one of them while the others wait.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "io/file_lock.hpp"

namespace voussoir::host {

/// The lock of one packing file, PACKING.lock beside it.
class PackingLock {
 public:
  /// @param note receives a line about a lock that another host left, about a file system without locks, and about the
  /// process that is waited for; it may be empty
  PackingLock(const std::filesystem::path& packing, std::int64_t seed, std::function<void(const std::string&)> note);

  /// Takes the lock if no process that runs holds it. A lock that another host has left is not trusted and taken: the
  /// worst that can happen is that both make the same packing. Throws std::system_error where the folder cannot be
  /// written to.
  [[nodiscard]] bool take();

  /// Waits until the process that holds the lock gives it back or dies. Throws Interrupted where a request to stop
  /// arrives meanwhile, and kernels::Stopped.
  void wait();

 private:
  std::filesystem::path file_;
  std::string name_;
  std::function<void(const std::string&)> note_;
  std::unique_ptr<io::FileLock> lock_;
  std::string holder_;  ///< the process that holds it, after `take` has failed
};

}  // namespace voussoir::host
