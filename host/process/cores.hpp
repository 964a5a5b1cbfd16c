#pragma once
/// The processor cores that this process may use: those that its affinity and its cpuset allow, and the share that its
/// control group (cgroup, version 1 or 2) grants, as containers and schedulers set it.

#include <filesystem>
#include <optional>
#include <string>

namespace voussoir::host {

struct Cores {
  int machine = 1;              ///< cores of the machine that are switched on
  int allowed = 1;              ///< those on which the process may run: affinity and cpuset
  std::optional<double> quota;  ///< processor time over wall time that the control group grants; none: no limit

  /// Number of threads that can run at a time. A part of a core counts as one, because its time would be lost.
  [[nodiscard]] int usable() const;
  /// Such as "2 cores are available: the machine has 8, the process may run on 4, its control group grants 1.5".
  [[nodiscard]] std::string text() const;
};

[[nodiscard]] Cores cores_of_this_process();

/// The smallest share that the control groups of this process grant: its own and those above it.
/// @param root folder in which proc/self/cgroup and proc/self/mountinfo lie
[[nodiscard]] std::optional<double> cpu_quota(const std::filesystem::path& root = "/");

}  // namespace voussoir::host
