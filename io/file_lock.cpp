#include "io/file_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <fstream>
#include <sstream>
#include <string_view>
#include <system_error>
#include <thread>

#include "io/hash.hpp"
#include "io/regular_file.hpp"
#include "io/utc.hpp"

namespace voussoir::io {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view first_line = "voussoir lock\n";
constexpr off_t most_text = 4096;  ///< a lock file is much shorter

[[noreturn]] void fail(const fs::path& path, const char* what) {
  throw std::system_error(errno, std::generic_category(), fmt::format("{}: the lock file {}", path.string(), what));
}

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 && name[0] != 0 ? name.data() : "unknown";
}

std::string machine_hash() {
  std::ifstream file("/etc/machine-id");
  std::string id;
  file >> id;
  return id.empty() ? "" : fingerprint_of("voussoir " + id);  // the id itself is not for others to read
}

/// Start of a process, the 22nd field of /proc/PID/stat; 0 where it cannot be read.
long long birth_of(int process) {
  std::ifstream file(fmt::format("/proc/{}/stat", process));
  std::string all;
  std::getline(file, all);
  const std::size_t name_end = all.rfind(')');  // the name before it may contain blanks
  if (name_end == std::string::npos) return 0;
  std::istringstream fields(all.substr(name_end + 1));
  std::string field;
  for (int k = 3; k <= 22; ++k) fields >> field;
  return std::strtoll(field.c_str(), nullptr, 10);
}

std::string file_text(const LockHolder& holder) {
  return fmt::format("{}host {}\nmachine {}\nprocess {}\nsince {}\nborn {}\n", first_line, holder.host, holder.machine,
                     holder.process, holder.since, holder.born_tick);
}

std::optional<LockHolder> holder_in(const std::string& text) {
  if (!text.starts_with(first_line)) return {};
  LockHolder holder;
  std::istringstream lines(text.substr(first_line.size()));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t blank = line.find(' ');
    if (blank == std::string::npos) continue;
    const std::string key = line.substr(0, blank);
    const std::string value = line.substr(blank + 1);
    if (key == "host") holder.host = value;
    if (key == "machine") holder.machine = value;
    if (key == "process") holder.process = static_cast<int>(std::strtol(value.c_str(), nullptr, 10));
    if (key == "since") holder.since = value;
    if (key == "born") holder.born_tick = std::strtoll(value.c_str(), nullptr, 10);
  }
  if (holder.host.empty() || holder.process <= 0) return {};
  return holder;
}

std::string text_of(int file) {
  std::string text(most_text, '\0');
  const ssize_t n = ::pread(file, text.data(), text.size(), 0);
  text.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
  return text;
}

/// Text of the file that has the name `path` now; nothing, with the reason in errno, where there is none to read.
std::optional<std::string> text_at(const fs::path& path) {
  const int file = open_regular(path, O_RDONLY);
  if (file < 0) return {};
  std::string text = text_of(file);
  ::close(file);
  return text;
}

fs::path folder_of(const fs::path& path) { return path.parent_path().empty() ? fs::path(".") : path.parent_path(); }

/// What identifies a folder whatever its name; zeros where there is none.
std::pair<std::uint64_t, std::uint64_t> identity_of(const fs::path& folder) {
  struct stat there{};
  if (::stat(folder.c_str(), &there) != 0) return {};
  return {there.st_dev, there.st_ino};
}

/// True where the open file is the one that has the name `path` now.
bool is_at(int file, const fs::path& path) {
  struct stat ours{};
  struct stat there{};
  return ::fstat(file, &ours) == 0 && ::stat(path.c_str(), &there) == 0 && ours.st_dev == there.st_dev &&
         ours.st_ino == there.st_ino;
}

void write_text(int file, const fs::path& path, const std::string& text) {
  errno = 0;
  const bool good = ::ftruncate(file, 0) == 0 &&
                    ::pwrite(file, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size());
  if (!good) {
    if (errno == 0) errno = ENOSPC;  // a short write says no reason
    fail(path, "cannot be written");
  }
}

/// True where the process that took a lock still runs. Its number alone does not say so, since numbers are used again.
bool runs_here(const LockHolder& holder) {
  if (!holder.on_this_host()) return false;
  if (::kill(holder.process, 0) != 0 && errno != EPERM) return false;
  return holder.born_tick == 0 || birth_of(holder.process) == holder.born_tick;
}

/// True where the file still has the text that this process wrote, a moment later. Without locks of the file system two
/// processes may both find the file free; then the last to write stays.
bool stays(const fs::path& path, const std::string& text) {
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  return text_at(path) == text;
}

/// The holder as the text names it, which is asked for anew. A process that took the lock in this moment has not
/// written its name yet.
template <class Text>
std::optional<LockHolder> holder_soon(const Text& text) {
  constexpr int looks = 25;
  for (int k = 0; k < looks; ++k) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    if (auto holder = holder_in(text())) return holder;
  }
  return {};
}

bool is_this_process(const LockHolder& holder) {
  return holder.on_this_host() && holder.process == static_cast<int>(::getpid());
}

}  // namespace

bool is_missing_feature(int reason) {
  return reason == EINVAL || reason == ENOSYS || reason == ENOTSUP || reason == EOPNOTSUPP || reason == ENOLCK;
}

std::string LockHolder::text() const { return fmt::format("process {} on host {} since {}", process, host, since); }

bool LockHolder::on_this_host() const {
  const std::string ours = machine_hash();  // empty where the file of its name cannot be read
  return host == host_name() && (machine.empty() || ours.empty() || machine == ours);
}

LockHolder this_process() {
  return {.host = host_name(),
          .machine = machine_hash(),
          .process = static_cast<int>(::getpid()),
          .since = utc_now(),
          .born_tick = birth_of(static_cast<int>(::getpid()))};
}

int FileLock::ask_kernel(int file) {
  struct flock whole{};
  whole.l_type = F_WRLCK;
  whole.l_whence = SEEK_SET;
  return ::fcntl(file, F_OFD_SETLK, &whole);
}

FileLock::~FileLock() {
  // Removed before it is given back: whoever opened the file before finds that it is not at its name any more. The file
  // is not opened once more, because the process may have no descriptor left.
  if (!text_.empty() && file_ >= 0 && is_at(file_, path_) && text_of(file_) == text_) ::unlink(path_.c_str());
  close_file();
}

void FileLock::close_file() {
  if (file_ >= 0) ::close(file_);
  file_ = -1;
}

bool FileLock::make_anew() {
  const int file = open_regular(path_, O_RDWR | O_CREAT | O_EXCL);
  if (file < 0 && errno != EEXIST) fail(path_, "was removed and cannot be made anew");
  if (file < 0) return false;
  if (by_kernel_ && ask_(file) != 0) {
    ::close(file);
    return false;
  }
  close_file();
  file_ = file;
  write_text(file_, path_, text_);
  return true;
}

FileLock::Standing FileLock::confirm() {
  if (identity_of(folder_of(path_)) != folder_) return Standing::gone;
  std::optional<std::string> now = text_at(path_);
  const bool missing = !now && errno == ENOENT;
  if (missing && make_anew()) return Standing::made_anew;
  const bool same = is_at(file_, path_);
  if (!now && same) now = text_of(file_);  // somebody has taken the right to open it away
  if (now == text_) return Standing::ours;
  const auto holder = holder_soon([&] { return text_at(path_).value_or(""); });
  if (holder && !is_this_process(*holder)) return Standing::taken_over;
  if (!same) return Standing::replaced;
  write_text(file_, path_, text_);
  return Standing::rewritten;
}

LockAttempt LockAttempt::make(const fs::path& path, bool take_over, FileLock::Ask ask) {
  for (;;) {
    std::unique_ptr<FileLock> lock(new FileLock(path, ask));
    lock->file_ = open_regular(path, O_RDWR | O_CREAT);
    if (lock->file_ < 0 && (errno == EISDIR || errno == ENXIO)) return {nullptr, Refusal::not_a_lock, {}};
    if (lock->file_ < 0) fail(path, "cannot be made");
    const int answer = ask(lock->file_);
    if (answer != 0 && !is_missing_feature(errno)) {
      if (errno != EAGAIN && errno != EACCES && errno != EINTR) fail(path, "cannot be locked");
      std::optional<LockHolder> holder = holder_soon([&] { return text_of(lock->file_); });
      // The holder may have ended since, and the next look will find no lock.
      if (!holder && !is_at(lock->file_, path)) continue;
      return {nullptr, Refusal::running, std::move(holder)};
    }
    lock->by_kernel_ = answer == 0;
    if (!is_at(lock->file_, path)) continue;  // its holder removed it in this moment
    const std::string text = text_of(lock->file_);
    const std::optional<LockHolder> holder = holder_in(text);
    if (!text.empty() && !text.starts_with(first_line.substr(0, text.size())))
      return {nullptr, Refusal::not_a_lock, {}};
    if (holder && !lock->by_kernel_ && runs_here(*holder)) return {nullptr, Refusal::running, holder};
    if (holder && !holder->on_this_host() && !take_over) return {nullptr, Refusal::other_host, holder};
    lock->text_ = file_text(this_process());
    lock->folder_ = identity_of(folder_of(path));
    write_text(lock->file_, path, lock->text_);
    if (!lock->by_kernel_ && !stays(path, lock->text_))
      return {nullptr, Refusal::running, holder_in(text_at(path).value_or(""))};
    return {std::move(lock), Refusal::none, holder && !holder->on_this_host() ? holder : std::nullopt};
  }
}

std::optional<LockHolder> running_holder(const fs::path& path) {
  const int file = open_regular(path, O_RDONLY);
  if (file < 0) return {};
  struct flock whole{};
  whole.l_type = F_RDLCK;
  whole.l_whence = SEEK_SET;
  const int answer = ::fcntl(file, F_OFD_GETLK, &whole);
  std::optional<LockHolder> holder = holder_in(text_of(file));
  ::close(file);
  const bool held = answer == 0 ? whole.l_type != F_UNLCK : holder && runs_here(*holder);
  if (!held) return {};
  return holder ? holder : LockHolder{};
}

}  // namespace voussoir::io
