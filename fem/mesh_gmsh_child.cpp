#include "fem/mesh_gmsh_child.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <limits>
#include <new>
#include <stdexcept>
#include <system_error>
#include <thread>

namespace voussoir::fem {

namespace {

using Clock = std::chrono::steady_clock;

// The child's answer ends with one of these letters; one that lacks it is not whole.
constexpr char has_result = 'r';
constexpr char has_sentence = 's';
constexpr char lacks_memory = 'm';

constexpr int ended_itself = 1;  ///< exit status where the code calls std::exit

std::string error_text(int error) { return std::system_category().message(error); }

// ---- in the child -----------------------------------------------------------------------------------------------

/// The size of this process's address space [bytes].
std::size_t address_space() {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

void lower_limit(int resource, rlim_t value) {
  rlimit limit{};
  getrlimit(static_cast<__rlimit_resource>(resource), &limit);
  limit.rlim_cur = std::min(limit.rlim_cur, value);
  setrlimit(static_cast<__rlimit_resource>(resource), &limit);
}

/// Makes the child silent, mortal and limited.
void settle_child(pid_t parent, std::size_t bytes) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(ended_itself);  // the parent ended before
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGPIPE}) std::signal(signal, SIG_DFL);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGXCPU}) std::signal(signal, SIG_IGN);
  // What the parent has registered for its end must not run here where the code calls std::exit.
  std::atexit([] { _exit(ended_itself); });
  const int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (nowhere >= 0) dup2(nowhere, stream);
  }
  lower_limit(RLIMIT_CORE, 0);
  const std::size_t now = address_space();
  if (now > 0) lower_limit(RLIMIT_AS, now + bytes);
}

std::string answer_of(const std::function<std::string()>& work) {
  try {
    return work() + has_result;
  } catch (const std::bad_alloc&) {
    return {lacks_memory};
  } catch (const std::exception& fault) {
    return std::string(fault.what()) + has_sentence;
  }
}

[[noreturn]] void run_child(const std::function<std::string()>& work, int pipe_end) {
  const std::string answer = answer_of(work);
  for (std::size_t done = 0; done < answer.size();) {
    const ssize_t n = write(pipe_end, answer.data() + done, answer.size() - done);
    if (n < 0 && errno != EINTR) _exit(ended_itself);
    if (n > 0) done += static_cast<std::size_t>(n);
  }
  _exit(0);
}

// ---- in the parent ----------------------------------------------------------------------------------------------

/// Closes a file's descriptor.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(number_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int number() const { return number_; }

 private:
  int number_;
};

/// Milliseconds until then, at least 0.
int milliseconds_to(Clock::time_point end) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now()).count();
  return static_cast<int>(std::clamp<long long>(left, 0, std::numeric_limits<int>::max()));
}

/// Ends a process and leaves no zombie.
class Child {
 public:
  explicit Child(pid_t process) : process_(process) {}
  ~Child() {
    if (process_ > 0) kill(process_, SIGKILL);
    static_cast<void>(wait(0));
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Whether the child has ended before then; it has where nobody knows it any more.
  bool ends_before(Clock::time_point end) {
    while (!wait(WNOHANG)) {
      if (milliseconds_to(end) == 0) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
  }
  /// What waitpid told of a child that has ended.
  [[nodiscard]] int status() const { return status_; }

 private:
  bool wait(int options) {
    pid_t ended = process_;
    while (process_ > 0 && (ended = waitpid(process_, &status_, options)) < 0 && errno == EINTR) {
    }
    if (ended != 0) process_ = 0;
    return process_ == 0;
  }

  pid_t process_;
  int status_ = 0;
};

/// Whether all that the child writes came before then.
bool read_all(int pipe_end, Clock::time_point end, std::string& text) {
  std::array<char, 1 << 16> part{};
  while (true) {
    pollfd waiting{.fd = pipe_end, .events = POLLIN, .revents = 0};
    const int ready = poll(&waiting, 1, milliseconds_to(end));
    if (ready == 0) return false;
    if (ready < 0) {
      if (errno == EINTR) continue;
      throw std::runtime_error("nothing comes from the process that reads it: " + error_text(errno));
    }
    const ssize_t n = read(pipe_end, part.data(), part.size());
    if (n == 0) return true;
    if (n > 0) text.append(part.data(), static_cast<std::size_t>(n));
    if (n < 0 && errno != EINTR) return true;
  }
}

std::string end_text(int status) {
  return "Gmsh ended " +
         (WIFSIGNALED(status) ? "by signal " + std::to_string(WTERMSIG(status))
                              : "with the status " + std::to_string(WEXITSTATUS(status))) +
         " while it read the file";
}

/// What a child's whole answer says.
std::string result_of(std::string answer, const ChildLimits& limits, int status) {
  const char kind = answer.empty() || status != 0 ? '\0' : answer.back();
  if (!answer.empty()) answer.pop_back();
  if (kind == has_result) return answer;
  if (kind == has_sentence) throw std::runtime_error(answer);
  if (kind == lacks_memory)
    throw std::runtime_error("Gmsh needed more than " + std::to_string(limits.bytes >> 20U) +
                             " MB of memory while it read the file");
  throw std::runtime_error(end_text(status));
}

}  // namespace

std::string in_child(const std::function<std::string()>& work, const ChildLimits& limits) {
  const auto refuse = [](int error) {
    throw std::runtime_error("no process can be started that reads it: " + error_text(error));
  };
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) refuse(errno);
  const Descriptor from(ends[0]);
  std::string answer;
  const pid_t parent = getpid();
  const auto end = Clock::now() +
                   std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limits.seconds));
  const pid_t process = fork();
  if (process == 0) {
    settle_child(parent, limits.bytes);
    run_child(work, ends[1]);
  }
  const int error = errno;
  close(ends[1]);
  if (process < 0) refuse(error);
  Child child(process);
  if (!read_all(from.number(), end, answer) || !child.ends_before(end))
    throw std::runtime_error("Gmsh did not come to an end within " + std::to_string(std::lround(limits.seconds)) +
                             " s");
  return result_of(std::move(answer), limits, child.status());
}

}  // namespace voussoir::fem
