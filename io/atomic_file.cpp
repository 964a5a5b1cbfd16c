#include "io/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "io/file_lock.hpp"
#include "io/regular_file.hpp"

namespace voussoir::io {

namespace {

constexpr std::size_t buffer_size = std::size_t{1} << 18;
constexpr int most_names = 100;

std::string text_of(int reason) {
  const std::string text = std::generic_category().message(reason);
  return reason == EFBIG ? text + ", the limit is that of `ulimit -f` or of the file system" : text;
}

/// Syncs an open file or folder; returns 0 or the reason of the failure. Where a file system cannot sync, the rename
/// alone must suffice.
int sync(int file) { return ::fsync(file) == 0 || is_missing_feature(errno) ? 0 : errno; }

int sync_folder(const std::filesystem::path& folder) {
  const int file = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) {
    return errno;
  }
  const int reason = sync(file);
  ::close(file);
  return reason;
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path target) : target_(std::move(target)) {
  // Two processes may have the same number on two hosts or in two containers that share a folder, and a killed process
  // may have had the number of this one.
  for (int k = 0; k < most_names; ++k) {
    const std::string further = k == 0 ? "" : fmt::format("-{}", k);
    if (open_as(fmt::format("{}.{}{}.tmp", target_.string(), ::getpid(), further))) {
      return;
    }
  }
  fail(EEXIST);
}

AtomicFile::~AtomicFile() {
  if (file_ >= 0) {
    ::unlink(temporary_.c_str());
    ::close(file_);
  }
}

/// Creates and locks the temporary file; false where this name is not to be had.
bool AtomicFile::open_as(const std::filesystem::path& name) {
  const int file = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0) {
    const int reason = errno;
    if (reason == EEXIST) {
      return false;
    }
    fail(reason);
  }
  const int locked = FileLock::ask_kernel(file) == 0 ? 0 : errno;
  struct stat status{};
  // Between the two calls a cleaner may have taken the file for a leftover.
  const bool lost = (locked != 0 && !is_missing_feature(locked)) || ::fstat(file, &status) != 0 || status.st_nlink == 0;
  if (lost) {
    ::close(file);
    return false;
  }
  temporary_ = name;
  file_ = file;
  return true;
}

void AtomicFile::fail(int reason) {
  throw std::runtime_error(fmt::format("{}: cannot be written: {}", target_.string(), text_of(reason)));
}

void AtomicFile::write(std::span<const std::byte> bytes) {
  if (buffer_.size() + bytes.size() > buffer_size) {
    flush();
  }
  if (bytes.size() >= buffer_size) {
    write_through(bytes);
  } else {
    buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
  }
}

void AtomicFile::flush() {
  write_through(buffer_);
  buffer_.clear();
}

void AtomicFile::write_through(std::span<const std::byte> bytes) {
  constexpr std::size_t most = std::size_t{1} << 30;  // Linux writes no more than 2 GB in one call
  while (!bytes.empty()) {
    const ssize_t written = ::write(file_, bytes.data(), std::min(bytes.size(), most));
    if (written > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    } else if (written == 0 || errno != EINTR) {
      fail(written == 0 ? EIO : errno);
    }
  }
}

void AtomicFile::publish() {
  flush();
  if (const int reason = sync(file_)) {
    fail(reason);
  }
  // The file is renamed before it is closed, because its lock ends there.
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) {
    fail(errno);
  }
  if (::close(std::exchange(file_, -1)) != 0 && errno != EINTR) {
    fail(errno);
  }
  if (const int reason = sync_folder(target_.parent_path())) {
    fail(reason);
  }
}

void write_text(const std::filesystem::path& target, const std::string& text) {
  AtomicFile file(target);
  file.write(std::as_bytes(std::span(text.data(), text.size())));
  file.publish();
}

void remove_leftovers(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> temporaries;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".tmp" && entry.symlink_status().type() == std::filesystem::file_type::regular) {
      temporaries.push_back(entry.path());
    }
  }
  for (const auto& path : temporaries) {
    const int file = open_regular(path, O_WRONLY | O_NOFOLLOW);
    if (file < 0) {
      continue;  // its writer has renamed it by now, or it belongs to another user
    }
    if (FileLock::ask_kernel(file) == 0) {
      ::unlink(path.c_str());
    }
    ::close(file);
  }
}

}  // namespace voussoir::io
