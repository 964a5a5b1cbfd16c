#include "io/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace voussoir::io {

namespace {

void sync(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  // EINVAL: a file system that cannot sync (some network and FUSE mounts); there the rename alone must suffice.
  const bool good = file >= 0 && (::fsync(file) == 0 || errno == EINVAL);
  const int reason = errno;
  if (file >= 0) {
    ::close(file);
  }
  if (!good) {
    throw std::runtime_error(fmt::format("{}: cannot be synced to disk: {}", path.string(), std::strerror(reason)));
  }
}

/// Whether another process that still runs on this machine is writing the temporary file NAME.PID.tmp.
bool is_being_written(const std::filesystem::path& temporary) {
  const std::string number = temporary.stem().extension().string();  // ".PID"
  pid_t process = 0;
  const char* const end = number.data() + number.size();
  const bool named = number.size() > 1 &&
                     std::from_chars(number.data() + 1, end, process) == std::from_chars_result{end, std::errc{}};
  if (!named || process <= 0 || process == ::getpid()) {
    return false;
  }
  return ::kill(process, 0) == 0 || errno == EPERM;  // EPERM: it lives, but belongs to another user
}

}  // namespace

std::filesystem::path temporary_name(const std::filesystem::path& target) {
  return fmt::format("{}.{}.tmp", target.string(), ::getpid());
}

void publish(const std::filesystem::path& target) {
  const auto temporary = temporary_name(target);
  sync(temporary);
  std::error_code failure;
  std::filesystem::rename(temporary, target, failure);
  if (failure) {
    throw std::runtime_error(fmt::format("{}: cannot be renamed to {}: {}", temporary.string(),
                                         target.filename().string(), failure.message()));
  }
  const auto folder = target.parent_path();
  sync(folder.empty() ? std::filesystem::path(".") : folder);
}

void write_text(const std::filesystem::path& target, const std::string& text) {
  {
    std::ofstream file(temporary_name(target), std::ios::binary);
    file << text;
    file.close();
    if (!file) {
      throw std::runtime_error(fmt::format("{}: cannot be written", temporary_name(target).string()));
    }
  }
  publish(target);
}

void remove_leftovers(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> leftovers;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".tmp" && !is_being_written(entry.path())) {
      leftovers.push_back(entry.path());
    }
  }
  for (const auto& path : leftovers) {
    std::filesystem::remove(path);
  }
}

}  // namespace voussoir::io
