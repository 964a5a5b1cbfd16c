#include "host/packing/packing_locks.hpp"

#include <spdlog/fmt/fmt.h>

#include <chrono>
#include <cstdio>
#include <thread>
#include <utility>

#include "host/process/exit_code.hpp"
#include "host/process/interrupt.hpp"
#include "kernels/state/stop_request.hpp"

namespace voussoir::host {

PackingLock::PackingLock(const std::filesystem::path& packing, std::int64_t seed,
                         std::function<void(const std::string&)> note)
    : file_(packing), name_(fmt::format("packing of seed {}", seed)), note_(std::move(note)) {
  file_.replace_extension(".lock");
}

bool PackingLock::take() {
  using Refusal = io::LockAttempt::Refusal;
  io::LockAttempt attempt = io::LockAttempt::make(file_, true);
  if (attempt.refusal == Refusal::running) {
    holder_ = attempt.holder ? attempt.holder->text() : "another process";
    return false;
  }
  lock_ = std::move(attempt.lock);
  if (!note_) return true;
  if (attempt.refusal == Refusal::not_a_lock)
    note_(fmt::format("{}: {} is no lock file of this program and is passed over", name_, file_.string()));
  if (lock_ && attempt.holder)
    note_(fmt::format("{}: {} did not give its lock back, which is taken over", name_, attempt.holder->text()));
  if (lock_ && !lock_->by_kernel())
    note_(fmt::format("{}: the file system has no locks, so that another process may make the same packing", name_));
  return true;
}

void PackingLock::wait() {
  constexpr auto nap = std::chrono::milliseconds(100);
  std::string said;
  while (!take()) {
    if (note_ && said != holder_) {
      note_(fmt::format("{}: waits for {}, which is at work on it", name_, holder_));
      std::fflush(stdout);
    }
    said = holder_;
    kernels::end_where_stopped(kernels::stop_flag());
    if (interrupted())
      throw Interrupted(fmt::format("{}: the run was stopped on request while it waited for {}", name_, holder_));
    std::this_thread::sleep_for(nap);
  }
}

}  // namespace voussoir::host
