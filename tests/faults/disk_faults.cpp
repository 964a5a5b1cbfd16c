// A library to be preloaded into the program (LD_PRELOAD): it makes the n-th change of a file system fail. Counted are
// the calls that open a file for writing, write, sync, truncate, rename, remove and make folders, for paths that
// match a pattern. Environment:
//   DISK_FAULTS_PATTERN  a pattern of fnmatch for absolute paths; "*" stands for slashes too, "@(A|B)" for either
//   DISK_FAULTS_AT       number of the call that fails, from 1; 0 or nothing: no call fails
//   DISK_FAULTS_ERRNO    the reason, as a number
//   DISK_FAULTS_MODE     "once", or "on": every later call fails too, except those that remove files, as on a full
//   disk;
//                        a write of several bytes first writes a half of them; "never": no call fails
//   DISK_FAULTS_DELAY    time by which the call of this number is late [ms]
//   DISK_FAULTS_COUNT    a file that gets the number of calls and a list of them when the program ends
#include <dlfcn.h>
#include <fcntl.h>
#include <fnmatch.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <string>

namespace {

struct Settings {
  std::string pattern;
  std::string count_file;
  long at = 0;
  int reason = ENOSPC;
  bool on = false;
  bool never = false;
  long delay = 0;
};

const char* variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

/// Never destroyed, because the program writes until its very end.
const Settings& settings() {
  static const Settings* const all = [] {
    auto* read = new Settings;
    read->pattern = variable("DISK_FAULTS_PATTERN");
    read->count_file = variable("DISK_FAULTS_COUNT");
    read->at = std::atol(variable("DISK_FAULTS_AT"));
    read->reason = std::atoi(variable("DISK_FAULTS_ERRNO"));
    read->on = std::string(variable("DISK_FAULTS_MODE")) == "on";
    read->never = std::string(variable("DISK_FAULTS_MODE")) == "never";
    read->delay = std::atol(variable("DISK_FAULTS_DELAY"));
    return read;
  }();
  return *all;
}

std::atomic<long> calls{0};

/// The real function behind an interposed one.
template <class Function>
Function* real(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

bool matches(const std::string& path) {
  return !settings().pattern.empty() && fnmatch(settings().pattern.c_str(), path.c_str(), FNM_EXTMATCH) == 0;
}

std::string absolute(const char* path) {
  if (path[0] == '/') return path;
  std::array<char, PATH_MAX> here{};
  return std::string(getcwd(here.data(), here.size()) == nullptr ? "" : here.data()) + "/" + path;
}

std::string path_of(int file) {
  std::array<char, PATH_MAX> target{};
  const std::string link = "/proc/self/fd/" + std::to_string(file);
  const ssize_t length = readlink(link.c_str(), target.data(), target.size() - 1);
  return length > 0 ? std::string(target.data()) : "";
}

std::string& report() {
  static auto* const text = new std::string;
  return *text;
}

long count(const char* call, const std::string& path) {
  static auto* const guard = new std::mutex;
  const std::lock_guard<std::mutex> lock(*guard);
  report() += std::string(call) + " " + path + "\n";
  return ++calls;
}

enum class Fate { passes, fails, fails_after_half };

/// Counts a call for `path` and says what becomes of it.
Fate fate(const char* call, const std::string& path) {
  if (!matches(path)) return Fate::passes;
  const Settings& s = settings();
  const long number = count(call, path);
  if (s.at > 0 && number == s.at) usleep(static_cast<useconds_t>(1000 * s.delay));
  if (s.at <= 0 || number < s.at || s.never) return Fate::passes;
  if (number == s.at) return s.on ? Fate::fails_after_half : Fate::fails;
  const bool removes = std::strcmp(call, "remove") == 0;
  return s.on && !removes ? Fate::fails : Fate::passes;
}

bool refused(const char* call, const std::string& path) {
  if (fate(call, path) == Fate::passes) return false;
  errno = settings().reason;
  return true;
}

bool opens_for_writing(int flags) { return (flags & O_ACCMODE) != O_RDONLY || (flags & (O_CREAT | O_TRUNC)) != 0; }

int open_file(int folder, const char* path, int flags, mode_t mode) {
  if (opens_for_writing(flags) && refused("open", absolute(path))) return -1;
  return static_cast<int>(syscall(SYS_openat, folder, path, flags, mode));
}

mode_t mode_from(int flags, va_list arguments) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? static_cast<mode_t>(va_arg(arguments, int)) : 0;
}

std::FILE* open_stream(const char* name, const char* path, const char* mode) {
  if (std::strpbrk(mode, "wa+") != nullptr && refused("open", absolute(path))) return nullptr;
  return real<std::FILE*(const char*, const char*)>(name)(path, mode);
}

struct AtExit {
  ~AtExit() {
    if (settings().count_file.empty()) return;
    const int file = static_cast<int>(
        syscall(SYS_openat, AT_FDCWD, settings().count_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644));
    const std::string text = std::to_string(calls.load()) + "\n" + report();
    syscall(SYS_write, file, text.data(), text.size());
    syscall(SYS_close, file);
  }
};
const AtExit at_exit;

}  // namespace

// The functions are those of the C library.
extern "C" {

int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_from(flags, arguments);
  va_end(arguments);
  return open_file(AT_FDCWD, path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_from(flags, arguments);
  va_end(arguments);
  return open_file(AT_FDCWD, path, flags, mode);
}

std::FILE* fopen(const char* path, const char* mode) { return open_stream("fopen", path, mode); }
std::FILE* fopen64(const char* path, const char* mode) { return open_stream("fopen64", path, mode); }

ssize_t write(int file, const void* bytes, size_t size) {
  switch (fate("write", path_of(file))) {
    case Fate::passes:
      return syscall(SYS_write, file, bytes, size);
    case Fate::fails_after_half:
      if (size > 1) return syscall(SYS_write, file, bytes, size / 2);
      [[fallthrough]];
    case Fate::fails:
      break;
  }
  errno = settings().reason;
  return -1;
}

ssize_t writev(int file, const iovec* pieces, int count) {
  if (refused("write", path_of(file))) return -1;
  return syscall(SYS_writev, file, pieces, count);
}

ssize_t pwrite(int file, const void* bytes, size_t size, off_t at) {
  if (refused("write", path_of(file))) return -1;
  return syscall(SYS_pwrite64, file, bytes, size, at);
}

ssize_t pwrite64(int file, const void* bytes, size_t size, off_t at) { return pwrite(file, bytes, size, at); }

// A stream's buffer is written by the C library's own call, which cannot be interposed.
int fflush(std::FILE* stream) {
  if (stream != nullptr && refused("flush", path_of(fileno(stream)))) return EOF;
  return real<int(std::FILE*)>("fflush")(stream);
}

int fsync(int file) {
  if (refused("sync", path_of(file))) return -1;
  return static_cast<int>(syscall(SYS_fsync, file));
}

int fdatasync(int file) {
  if (refused("sync", path_of(file))) return -1;
  return static_cast<int>(syscall(SYS_fdatasync, file));
}

int ftruncate(int file, off_t size) {
  if (refused("truncate", path_of(file))) return -1;
  return static_cast<int>(syscall(SYS_ftruncate, file, size));
}

int ftruncate64(int file, off_t size) { return ftruncate(file, size); }

int rename(const char* from, const char* to) {
  if (refused("rename", absolute(to))) return -1;
  return static_cast<int>(syscall(SYS_rename, from, to));
}

int unlink(const char* path) {
  if (refused("remove", absolute(path))) return -1;
  return static_cast<int>(syscall(SYS_unlink, path));
}

int unlinkat(int folder, const char* path, int flags) {
  const std::string where = folder == AT_FDCWD ? absolute(path) : path_of(folder) + "/" + path;
  if (refused("remove", where)) return -1;
  return static_cast<int>(syscall(SYS_unlinkat, folder, path, flags));
}

int remove(const char* path) {
  if (refused("remove", absolute(path))) return -1;
  return real<int(const char*)>("remove")(path);
}

int mkdir(const char* path, mode_t mode) {
  if (refused("mkdir", absolute(path))) return -1;
  return static_cast<int>(syscall(SYS_mkdir, path, mode));
}
}
