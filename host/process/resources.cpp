#include "host/process/resources.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

namespace voussoir::host {
namespace {

/// The number in a file of a cgroup; `otherwise` where the file is missing or says "max".
double number_in(const std::filesystem::path& file, double otherwise) {
  double value = otherwise;
  return std::ifstream(file) >> value ? value : otherwise;
}

/// The least limit of the cgroups that this process is in. Inside a container its own group often is the root that the
/// container sees, so that the root is asked, too.
double cgroup_limit(double most) {
  const std::filesystem::path root = "/sys/fs/cgroup";
  double least = std::min(number_in(root / "memory.max", most), number_in(root / "memory/memory.limit_in_bytes", most));
  std::ifstream groups("/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    const bool unified = line.starts_with("0::");
    const std::size_t name = line.find(":memory:");
    if (!unified && name == std::string::npos) continue;
    const std::filesystem::path top = unified ? root : root / "memory";
    const char* file = unified ? "memory.max" : "memory.limit_in_bytes";
    std::filesystem::path group = top / std::filesystem::path(line.substr(unified ? 3 : name + 8)).relative_path();
    for (; group != top && group.has_relative_path() && group.string().size() > top.string().size();
         group = group.parent_path()) {
      least = std::min(least, number_in(group / file, most));
    }
  }
  return least;
}

}  // namespace

double peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

double memory_limit() {
  const double machine = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  rlimit own{};
  const bool limited = getrlimit(RLIMIT_AS, &own) == 0 && own.rlim_cur != RLIM_INFINITY;
  return std::min(cgroup_limit(machine), limited ? static_cast<double>(own.rlim_cur) : machine);
}

}  // namespace voussoir::host
