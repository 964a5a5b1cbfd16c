#pragma once
/// Locks between processes. A lock is an open-file-description lock (fcntl(2), F_OFD_SETLK) on a small file, whose text
/// says which process on which host holds it. The kernel gives the lock back when the process ends, however it ends, so
/// that a file which a killed process left blocks nobody on this host.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace voussoir::io {

/// True for a failure of a lock or of fsync (errno) that says that the file system lacks it, as some network and FUSE
/// mounts do.
[[nodiscard]] bool is_missing_feature(int reason);

/// The process that a lock file names.
struct LockHolder {
  std::string host;     ///< name of the machine, or of the container
  std::string machine;  ///< hash of /etc/machine-id, because two machines may have one name; may be empty
  int process = 0;
  std::string since;        ///< when it took the lock, UTC
  long long born_tick = 0;  ///< start of the process in the kernel's ticks, because process numbers are used again

  /// Such as "process 4711 on host n12 since 2026-11-26T09:41:10Z".
  [[nodiscard]] std::string text() const;
  [[nodiscard]] bool on_this_host() const;
};

/// The process that asks, as it would stand in a lock file.
[[nodiscard]] LockHolder this_process();

class FileLock {
 public:
  /// Asks the kernel for the lock of an open file and does not wait. It returns 0, or -1 with the reason in errno. The
  /// lock belongs to the open file and not to the process, so that two writers of one process differ, too.
  using Ask = int (*)(int file);
  static int ask_kernel(int file);

  ~FileLock();  ///< removes the lock file, if it is still this one, and gives the lock back
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

  /// False where the file system has no locks. Then the text of the file alone keeps others out: a process of this host
  /// that runs, and any process of another host.
  [[nodiscard]] bool by_kernel() const { return by_kernel_; }

  /// What has become of the lock file, which a user may have removed and another process may have replaced.
  enum class Standing {
    ours,        ///< it is as it was
    made_anew,   ///< it was gone and has been made anew
    rewritten,   ///< it was this process's own file with other bytes, and has its text again
    taken_over,  ///< it names another process now
    replaced,    ///< something else has its name, which names no process
    gone         ///< its folder is gone, or another one has its name
  };
  [[nodiscard]] Standing confirm();

 private:
  friend struct LockAttempt;
  FileLock(std::filesystem::path path, Ask ask) : path_(std::move(path)), ask_(ask) {}
  void close_file();
  /// Makes a lock file where there is none; false where another process was faster.
  [[nodiscard]] bool make_anew();

  std::filesystem::path path_;
  Ask ask_;
  int file_ = -1;
  std::pair<std::uint64_t, std::uint64_t> folder_ = {};  ///< device and number of the folder in which it was made
  bool by_kernel_ = true;
  std::string text_;  ///< what this process wrote into the file
};

/// One attempt to take a lock, which waits for nobody. Either `lock` is set or `refusal` says why it is not.
struct LockAttempt {
  enum class Refusal {
    none,
    running,     ///< the holder runs
    other_host,  ///< the file names a process of another host, which nobody here can ask, and was not given back
    not_a_lock   ///< the file holds something else, or is no regular file
  };
  std::unique_ptr<FileLock> lock;
  Refusal refusal = Refusal::none;
  /// Of a refusal, where the file says it; where the lock was taken, the process of another host that it was taken
  /// from.
  std::optional<LockHolder> holder;

  /// Takes the lock of the file `path`, which is made where it is missing.
  /// @param take_over takes a lock of another host too, as long as the kernel does not say that its holder runs
  /// Throws std::system_error naming the file, where it can be neither made nor written.
  [[nodiscard]] static LockAttempt make(const std::filesystem::path& path, bool take_over,
                                        FileLock::Ask ask = FileLock::ask_kernel);
};

/// The running process that holds the lock of `path`, without touching the lock; nothing where none does or where there
/// is no such file.
[[nodiscard]] std::optional<LockHolder> running_holder(const std::filesystem::path& path);

}  // namespace voussoir::io
