#include "host/record/run_lock.hpp"

#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>

#include "io/input_error.hpp"
#include "io/text_file.hpp"

namespace voussoir::host {
namespace {

namespace fs = std::filesystem;

std::string text_of(const std::optional<io::LockHolder>& holder) {
  return holder && holder->process > 0 ? holder->text() : "a process whose name the lock file does not tell";
}

[[noreturn]] void refuse(const fs::path& folder, const std::string& sentence) {
  throw io::InputError("--output", folder.string(), sentence);
}

/// What lies in place of a lock file, as the end of a sentence.
std::string what_is(const fs::path& file) {
  std::string fault = io::file_fault(file);
  if (!fault.empty()) return fault;
  std::error_code failure;
  return fs::file_size(file, failure) == 0 ? "is an empty file" : "is no lock file of this program";
}

/// A sweep holds the folder above those of its runs, and they are its children.
void expect_free_above(const fs::path& folder) {
  const fs::path above = fs::canonical(folder).parent_path();
  const auto holder = io::running_holder(above / run_lock_name);
  if (!holder || (holder->on_this_host() && holder->process == static_cast<int>(::getppid()))) return;
  refuse(folder, fmt::format("the folder above it is held by {}, which runs", text_of(holder)));
}

}  // namespace

void expect_unlocked(const fs::path& folder) {
  if (const auto holder = io::running_holder(folder / run_lock_name))
    refuse(folder, fmt::format("is held by {}, which runs", text_of(holder)));
}

RunLock::RunLock(const fs::path& folder, bool take_over) : folder_(folder) {
  fs::create_directories(folder);
  expect_free_above(folder);
  const fs::path file = folder / run_lock_name;
  io::LockAttempt attempt = io::LockAttempt::make(file, take_over);
  switch (attempt.refusal) {
    case io::LockAttempt::Refusal::none:
      break;
    case io::LockAttempt::Refusal::running:
      refuse(folder, fmt::format("is held by {}, which runs", text_of(attempt.holder)));
    case io::LockAttempt::Refusal::other_host:
      refuse(folder, fmt::format("was not given back by {}: add --take-over if that process has ended, as where a "
                                 "scheduler has moved the job",
                                 text_of(attempt.holder)));
    case io::LockAttempt::Refusal::not_a_lock:
      refuse(folder,
             fmt::format("its {} {}; where no process uses the folder, remove it", run_lock_name, what_is(file)));
  }
  lock_ = std::move(attempt.lock);
  expect_unlocked(folder / "column");
  if (attempt.holder) note_ = fmt::format("the folder was taken over from {}", text_of(attempt.holder));
  if (!lock_->by_kernel()) {
    note_ = fmt::format("{}the file system of {} has no locks: only the text of {} keeps other runs out of the folder",
                        note_.empty() ? "" : note_ + "; ", folder.string(), file.string());
  }
}

std::string RunLock::confirm() const {
  const fs::path file = folder_ / run_lock_name;
  switch (lock_->confirm()) {
    case io::FileLock::Standing::ours:
      return {};
    case io::FileLock::Standing::made_anew:
      return fmt::format("somebody removed {} while this run holds the folder; it was made anew", file.string());
    case io::FileLock::Standing::rewritten:
      return fmt::format("somebody changed {} while this run holds the folder; it has its text again", file.string());
    case io::FileLock::Standing::taken_over:
      throw std::runtime_error(
          fmt::format("{}: another process has taken the folder over; this run ends and leaves it", folder_.string()));
    case io::FileLock::Standing::replaced:
      throw std::runtime_error(
          fmt::format("{}: somebody has replaced it while this run holds the folder: it {}; this run ends, since it "
                      "cannot keep others out; where no process uses the folder, remove it, and --resume goes on",
                      file.string(), what_is(file)));
    case io::FileLock::Standing::gone:
      break;
  }
  throw std::runtime_error(
      fmt::format("{}: the folder was moved or removed while the run was writing into it", folder_.string()));
}

}  // namespace voussoir::host
