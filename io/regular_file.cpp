#include "io/regular_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <string>
#include <system_error>

namespace voussoir::io {

namespace {

[[noreturn]] void cannot_be_read(int reason) {
  if (reason == EISDIR || reason == ENXIO) {
    throw std::runtime_error(reason == EISDIR ? "is a folder" : "is a pipe or a device");
  }
  throw std::runtime_error("cannot be read: " + std::generic_category().message(reason));
}

}  // namespace

int open_regular(const std::filesystem::path& path, int flags) {
  constexpr mode_t by_umask = 0666;
  const int file = ::open(path.c_str(), flags | O_NONBLOCK | O_CLOEXEC, by_umask);
  if (file < 0) {
    return -1;
  }
  struct stat status{};
  const int reason = ::fstat(file, &status) != 0 ? errno
                     : S_ISREG(status.st_mode)   ? 0
                     : S_ISDIR(status.st_mode)   ? EISDIR
                                                 : ENXIO;
  if (reason == 0) {
    return file;
  }
  ::close(file);
  errno = reason;
  return -1;
}

std::vector<std::byte> read_regular(const std::filesystem::path& path) {
  const int file = open_regular(path, O_RDONLY);
  if (file < 0) {
    cannot_be_read(errno);
  }
  constexpr std::size_t most = std::size_t{1} << 30;  // Linux reads no more than 2 GB in one call
  std::vector<std::byte> bytes;
  struct stat status{};
  int reason = ::fstat(file, &status) == 0 ? 0 : errno;
  std::size_t filled = 0;
  try {
    bytes.resize(static_cast<std::size_t>(status.st_size));
  } catch (...) {
    ::close(file);
    throw;
  }
  while (reason == 0 && filled < bytes.size()) {
    const ssize_t n = ::read(file, bytes.data() + filled, std::min(bytes.size() - filled, most));
    if (n > 0) {
      filled += static_cast<std::size_t>(n);
    } else if (n == 0) {
      bytes.resize(filled);  // somebody has cut the file off meanwhile
    } else if (errno != EINTR) {
      reason = errno;
    }
  }
  ::close(file);
  if (reason != 0) {
    cannot_be_read(reason);
  }
  return bytes;
}

}  // namespace voussoir::io
