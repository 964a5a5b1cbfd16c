#include "host/process/standard_streams.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <system_error>

namespace voussoir::host {

void prepare_standard_streams() {
  for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; ++descriptor) {
    if (::fcntl(descriptor, F_GETFD) >= 0 || errno != EBADF) continue;
    // open() takes the lowest free number. The wrong direction makes reading or writing fail as on a closed descriptor.
    if (::open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY) < 0) return;
  }
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

bool print_answer(const std::string& answer) {
  errno = 0;
  if (std::fwrite(answer.data(), 1, answer.size(), stdout) == answer.size() && std::fflush(stdout) == 0) return true;
  const int reason = errno;
  if (reason != EPIPE) {
    std::fprintf(stderr, "voussoir: standard output: cannot be written: %s\n",
                 std::generic_category().message(reason).c_str());
  }
  return false;
}

std::optional<std::string> lost_output() {
  errno = 0;
  const bool failed = std::fflush(stdout) != 0;
  const int reason = errno;
  if (!failed && std::ferror(stdout) == 0) return {};
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere >= 0) {
    ::dup2(nowhere, STDOUT_FILENO);
    ::close(nowhere);
  }
  std::clearerr(stdout);
  return reason != 0 ? std::generic_category().message(reason) : "an earlier write failed";
}

}  // namespace voussoir::host
