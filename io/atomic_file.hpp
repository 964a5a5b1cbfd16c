#pragma once
/// Files that exist completely or not at all: the bytes go to a temporary name, which is synced and renamed.

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace voussoir::io {

/// A file on its way: TARGET.PID.tmp, which `publish` makes TARGET. The writer holds a lock on the temporary file, by
/// which every process on every host can tell it from the leftover of a killed writer. Every failure is a
/// std::runtime_error of one line that names the target and the system's reason; nothing is left behind then.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path target);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();  ///< removes the temporary file unless `publish` has succeeded

  void write(std::span<const std::byte> bytes);
  /// Syncs the file to the disk, renames it to the target and syncs the folder.
  void publish();

 private:
  [[nodiscard]] bool open_as(const std::filesystem::path& name);
  void flush();
  void write_through(std::span<const std::byte> bytes);
  [[noreturn]] void fail(int reason);

  std::filesystem::path target_;
  std::filesystem::path temporary_;
  int file_ = -1;
  std::vector<std::byte> buffer_;
};

/// Writes text through an AtomicFile.
void write_text(const std::filesystem::path& target, const std::string& text);

/// Removes the files that killed writers left in `folder`: those that end in ".tmp" and are not locked by their writer.
/// Where the file system has no locks, nothing is removed, because a living writer could not be told from a dead one.
void remove_leftovers(const std::filesystem::path& folder);

}  // namespace voussoir::io
